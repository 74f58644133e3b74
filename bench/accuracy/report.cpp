// SPDX-License-Identifier: BSD-3-Clause
#include "report.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace study {

namespace {

std::string triple(const Errors& errors) {
    return number(errors.loads) + " / " + number(errors.kinds) + " / " + number(errors.clamp);
}

std::string two_digits(double value) {
    std::ostringstream text;
    text.precision(2);
    text << value;
    return text.str();
}

/// A cell of a file of comma-separated values.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (char c : text) {
        result += c == '"' ? "\"\"" : std::string(1, c);
    }
    return result + '"';
}

/// The methods of some rows in the order they first come up, closed forms first.
std::vector<std::string> methods_of(const std::vector<Row>& rows) {
    std::vector<std::string> methods;
    for (bool closed : {true, false}) {
        for (const Row& row : rows) {
            for (const Score& score : row.scores) {
                if (score.is_closed_form == closed &&
                    std::find(methods.begin(), methods.end(), score.method) == methods.end()) {
                    methods.push_back(score.method);
                }
            }
        }
    }
    return methods;
}

/// The rows of a part as a table to read.
std::string row_table(const std::vector<Row>& rows) {
    const std::vector<std::string> methods = methods_of(rows);
    std::ostringstream page;
    page << "Relative error of held-out motion: unseen loads / unseen kinds of load / an unseen clamp. *ratio*: the "
            "lowest error of any closed form over that of `trajectory`, likewise.\n\n"
            "| mesh | nodes | springs | material | nu | network | setup |";
    std::string rule = "|---|---|---|---|---|---|---|";
    for (const std::string& method : methods) {
        page << " " << method << " |";
        rule += "---|";
    }
    page << " ratio |\n" << rule << "---|\n";
    for (const Row& row : rows) {
        page << "| " << row.mesh << " | " << row.nodes << " | " << row.springs << " | " << row.material << " | "
             << two_digits(row.poisson) << " | " << row.network << " | " << row.setup << " |";
        for (const std::string& method : methods) {
            const Score* score = row.find(method);
            page << " " << (score == nullptr ? "" : triple(score->errors)) << " |";
        }
        page << " " << (row.find("trajectory") == nullptr ? "" : triple(row.ratio())) << " |\n";
    }
    page << "\n";
    return page.str();
}

/// The same for other programs: one line per row and method.
std::string row_values(const std::vector<Row>& rows) {
    std::ostringstream csv;
    csv.precision(6);
    csv << "mesh,nodes,springs,material,poisson,network,setup,method,error_unseen_loads,error_unseen_kinds,"
           "error_unseen_clamp,seconds,note\n";
    for (const Row& row : rows) {
        for (const Score& score : row.scores) {
            csv << quoted(row.mesh) << "," << row.nodes << "," << row.springs << "," << quoted(row.material) << ","
                << row.poisson << "," << quoted(row.network) << "," << quoted(row.setup) << "," << quoted(score.method);
            for (double error : {score.errors.loads, score.errors.kinds, score.errors.clamp}) {
                csv << ",";
                if (!std::isnan(error)) {
                    csv << error;
                }
            }
            csv << "," << score.seconds << "," << quoted(score.note) << "\n";
        }
    }
    return csv.str();
}

std::string table_page(const Table& table) {
    std::ostringstream page;
    page << table.text << "\n\n|";
    for (const std::string& column : table.columns) {
        page << " " << column << " |";
    }
    page << "\n|";
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        page << "---|";
    }
    page << "\n";
    for (const auto& line : table.lines) {
        page << "|";
        for (const std::string& cell : line) {
            page << " " << cell << " |";
        }
        page << "\n";
    }
    page << "\n";
    return page.str();
}

std::string table_values(const Table& table) {
    std::ostringstream csv;
    const auto put = [&](const std::vector<std::string>& cells) {
        for (std::size_t c = 0; c < cells.size(); ++c) {
            csv << (c > 0 ? "," : "") << quoted(cells[c]);
        }
        csv << "\n";
    };
    put(table.columns);
    for (const auto& line : table.lines) {
        put(line);
    }
    return csv.str();
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char date[16];
    std::strftime(date, sizeof date, "%Y-%m-%d", &utc);
    return date;
}

/// Puts an item in the place of the one that is the same, or at the end.
template <class Item, class Same>
void put(std::vector<Item>& items, const Item& item, const Same& same) {
    const auto found = std::find_if(items.begin(), items.end(), same);
    if (found == items.end()) {
        items.push_back(item);
    } else {
        *found = item;
    }
}

constexpr const char* introduction =
    "How closely do mass-spring networks move like the material they stand for, on motion that no fit has seen?\n\n"
    "**What is compared.** Each row of a part is one body: a mesh, a material and a network of springs on the mesh's "
    "nodes. A finite element model of the same mesh is the reference. It is brought to rest under random load cases; "
    "fits learn from the *training* cases (smooth body forces, patches pushed and pulled, under several clamps), and "
    "every network, fitted or not, is judged by three sets that none has seen:\n\n"
    "- *unseen loads*: the training's kinds and clamps, other loads;\n"
    "- *unseen kinds*: gravity, stretch, bend, twist, press;\n"
    "- *unseen clamp*: the training's kinds of load, the body held elsewhere.\n\n"
    "**Error**: sqrt(sum |x - x_ref|^2 / sum |x_ref - x_rest|^2) over the nodes that are not clamped and all cases of "
    "a "
    "set. 0 is the reference itself, 1 as bad as not moving at all; *fails*: a case has no equilibrium.\n\n"
    "**Methods.** *Closed forms* are formulas from the literature and our own (docs/springs.md). *one pass*, *dominant "
    "term* and *exact* fit the accelerations of the training motions (docs/theory.md): where springs cannot represent "
    "the material they come out far too soft, however exact the minimum. *trajectory* matches the motion itself, from "
    "a "
    "closed form on (docs/trajectory.md).\n\n";

double ratio_of(double best, double own) {
    return own > 0 ? best / own : own == 0 && best > 0 ? std::numeric_limits<double>::infinity() : best / own;
}

} // namespace

std::string number(double value) {
    if (std::isnan(value)) {
        return "–";
    }
    if (std::isinf(value)) {
        return "fails";
    }
    std::ostringstream text;
    if (value != 0 && std::abs(value) < 1e-3) {
        text.precision(1);
        text << std::scientific << value;
    } else {
        text.precision(value >= 10 ? 1 : value >= 1 ? 2 : value >= 0.1 ? 3 : 4);
        text << std::fixed << value;
    }
    return text.str();
}

const Score* Row::find(const std::string& method) const {
    const auto found =
        std::find_if(scores.begin(), scores.end(), [&](const Score& score) { return score.method == method; });
    return found == scores.end() ? nullptr : &*found;
}

Errors Row::errors_of(const std::string& method) const {
    const Score* score = find(method);
    return score == nullptr ? Errors{} : score->errors;
}

Errors Row::best_closed_form() const {
    Errors best;
    const auto take = [](double& lowest, double value) {
        if (!std::isnan(value) && !(value >= lowest)) {
            lowest = value;
        }
    };
    for (const Score& score : scores) {
        if (score.is_closed_form) {
            take(best.loads, score.errors.loads);
            take(best.kinds, score.errors.kinds);
            take(best.clamp, score.errors.clamp);
        }
    }
    return best;
}

Errors Row::ratio(const std::string& method) const {
    const Score* own = find(method);
    if (own == nullptr) {
        return {};
    }
    const Errors best = best_closed_form();
    return {ratio_of(best.loads, own->errors.loads), ratio_of(best.kinds, own->errors.kinds),
            ratio_of(best.clamp, own->errors.clamp)};
}

Report::Report(std::filesystem::path folder, std::string command, unsigned seed, bool is_quick)
    : m_folder(std::move(folder)), m_command(std::move(command)), m_seed(seed), m_is_quick(is_quick) {
    std::filesystem::create_directories(m_folder);
}

void Report::begin(const std::string& id, const std::string& title, const std::string& text) {
    m_parts.push_back({id, title, text});
    m_of_part = {};
    std::cout << "\n" << title << std::endl;
}

void Report::end_part() {
    Part& part = m_parts.back();
    part.seconds = m_of_part.seconds();
    std::cout << "  " << std::lround(part.seconds) << " s" << std::endl;
    write_part(part);
    write_summary();
}

void Report::add(const Row& row) {
    std::cout << "  " << row.mesh << ", " << row.nodes << " nodes, " << row.material << ", nu "
              << two_digits(row.poisson) << ", " << row.network << (row.setup.empty() ? "" : ", " + row.setup)
              << ": closed form " << triple(row.best_closed_form());
    for (const Score& score : row.scores) {
        if (!score.is_closed_form) {
            std::cout << "; " << score.method << " " << triple(score.errors) << " (" << number(score.seconds) << " s)";
        }
    }
    std::cout << std::endl;
    m_parts.back().rows.push_back(row);
    write_part(m_parts.back());
    write_summary();
}

void Report::table(const Table& table) {
    put(m_parts.back().tables, table, [&](const Table& other) { return other.name == table.name; });
    write_part(m_parts.back());
    for (const std::string& cell : table.lines.empty() ? std::vector<std::string>{} : table.lines.back()) {
        std::cout << "  " << cell;
    }
    std::cout << std::endl;
}

void Report::note(const std::string& line) {
    std::cout << "  " << line << std::endl;
    m_parts.back().notes.push_back(line);
    write_part(m_parts.back());
}

void Report::figure(const std::string& name, const std::string& svg) {
    write(name + ".svg", svg);
    put(m_parts.back().figures, name, [&](const std::string& other) { return other == name; });
    write_part(m_parts.back());
}

void Report::at_most(const std::string& name, double value, double limit) {
    m_bars.push_back({name, value, limit, true});
}

void Report::at_least(const std::string& name, double value, double limit) {
    m_bars.push_back({name, value, limit, false});
}

void Report::must_be_at_most(const std::string& name, double value, double limit) {
    at_most(name, value, limit);
    m_has_failed = m_has_failed || !m_bars.back().is_met();
}

void Report::end(bool interrupted) {
    m_state = interrupted ? "cut short" : "complete";
    write_summary();
}

void Report::write(const std::string& name, const std::string& text) const {
    // Written beside and moved into place, so that an end at any moment leaves whole files.
    const std::filesystem::path path = m_folder / name;
    const std::filesystem::path beside = m_folder / (name + ".part");
    std::ofstream out(beside);
    out << text;
    if (!out.flush()) {
        throw std::runtime_error("cannot write " + path.string());
    }
    out.close();
    std::filesystem::rename(beside, path);
}

void Report::write_part(const Part& part) const {
    std::ostringstream page;
    page << "# " << part.title << "\n\n" << part.text << "\n\n";
    for (const std::string& name : part.figures) {
        page << "![" << name << "](" << name << ".svg)\n\n";
    }
    std::string files;
    const auto add_values = [&](const std::string& name, const std::string& values) {
        write(name + ".csv", values);
        files += (files.empty() ? "[" : ", [") + name + ".csv](" + name + ".csv)";
    };
    if (!part.rows.empty()) {
        page << row_table(part.rows);
        add_values(part.id, row_values(part.rows));
    }
    for (const Table& table : part.tables) {
        page << table_page(table);
        add_values(table.name, table_values(table));
    }
    for (const std::string& line : part.notes) {
        page << line << "\n\n";
    }
    page << (files.empty() ? "" : "All values: " + files + ". ") << "[Summary](README.md).\n";
    write(part.id + ".md", page.str());
}

std::string Report::bars() const {
    std::ostringstream page;
    page << "\n## Bars\n\nWhat the fits are held to: targets, with what was measured, met or not."
         << (m_is_quick ? " They belong to the finer meshes of the full study: the quick one reads them on coarse ones."
                        : "")
         << "\n\n| what | measured | bar | |\n|---|---|---|---|\n";
    long n_met = 0;
    for (const Bar& bar : m_bars) {
        n_met += bar.is_met() ? 1 : 0;
        page << "| " << bar.name << " | " << number(bar.value) << " | " << (bar.is_upper ? "<= " : ">= ")
             << number(bar.limit) << " | "
             << (std::isnan(bar.value) ? "not measured"
                 : bar.is_met()        ? "met"
                                       : "**not met**")
             << " |\n";
    }
    page << "\n" << n_met << " of " << m_bars.size() << " bars are met.\n";
    return page.str();
}

void Report::write_summary() const {
    std::ostringstream page;
    page << "# Accuracy study\n\n"
         << introduction << "- Command: `" << m_command << "` (" << (m_is_quick ? "the quick study" : "the full study")
         << ", " << m_state << ")\n- Machine: " << machine() << "\n- Seed: " << m_seed << "\n- Date: " << today()
         << "\n\n## Parts\n\n";
    for (const Part& part : m_parts) {
        page << "- [" << part.title << "](" << part.id << ".md)";
        if (part.seconds > 0) {
            page << ", " << std::lround(part.seconds) << " s";
        }
        page << "\n";
    }
    if (!m_bars.empty()) {
        page << bars();
    }
    write("README.md", page.str());
}

std::string machine() {
    std::string cpu = "unknown processor";
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        if (line.rfind("model name", 0) == 0) {
            cpu = line.substr(line.find(':') + 2);
            break;
        }
    }
    std::ostringstream text;
    text << cpu << ", " << std::thread::hardware_concurrency() << " cores, ";
#if defined(__clang__)
    text << "clang " << __clang_major__ << "." << __clang_minor__;
#elif defined(__GNUC__)
    text << "GCC " << __GNUC__ << "." << __GNUC_MINOR__;
#else
    text << "unknown compiler";
#endif
    return text.str();
}

} // namespace study
