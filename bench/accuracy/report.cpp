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

/// Two or three digits that count; "fails" where a network could not be simulated, a dash where nothing was measured.
std::string number(double value) {
    if (std::isnan(value)) {
        return "–";
    }
    if (std::isinf(value)) {
        return "fails";
    }
    std::ostringstream text;
    if (value != 0 && std::abs(value) < 1e-4) {
        text.precision(1);
        text << std::scientific << value;
    } else {
        text.precision(value >= 10 ? 1 : value >= 1 ? 2 : 4);
        text << std::fixed << value;
    }
    return text.str();
}

std::string triple(const Errors& errors) {
    return number(errors.loads) + " / " + number(errors.kinds) + " / " + number(errors.clamp);
}

std::string quoted(const std::string& text) {
    return '"' + text + '"';
}

double ratio_of(double best, double own) {
    return own > 0 ? best / own : own == 0 && best > 0 ? std::numeric_limits<double>::infinity() : best / own;
}

} // namespace

const Score* Row::find(const std::string& method) const {
    const auto found =
        std::find_if(scores.begin(), scores.end(), [&](const Score& score) { return score.method == method; });
    return found == scores.end() ? nullptr : &*found;
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
    std::cout << "\n" << title << std::endl;
}

void Report::add(Row row) {
    std::cout << "  " << row.mesh << ", " << row.nodes << " nodes, " << row.material << ", nu " << number(row.poisson)
              << ", " << row.network << (row.setup.empty() ? "" : ", " + row.setup) << ": ";
    const Errors best = row.best_closed_form();
    std::cout << "closed form " << triple(best);
    for (const Score& score : row.scores) {
        if (!score.is_closed_form) {
            std::cout << "; " << score.method << " " << triple(score.errors);
        }
    }
    std::cout << std::endl;
    m_parts.back().rows.push_back(std::move(row));
    write_part(m_parts.back());
    write_summary();
}

void Report::note(const std::string& line) {
    std::cout << "  " << line << std::endl;
    m_parts.back().notes.push_back(line);
    write_part(m_parts.back());
}

void Report::figure(const std::string& name, const std::string& svg) {
    write(name + ".svg", svg);
    m_parts.back().figures.push_back(name);
    write_part(m_parts.back());
}

void Report::at_most(const std::string& name, double value, double limit) {
    m_bars.push_back({name, value, limit, true});
}

void Report::at_least(const std::string& name, double value, double limit) {
    m_bars.push_back({name, value, limit, false});
}

void Report::end(bool interrupted) {
    m_state = interrupted ? "cut short" : "complete";
    write_summary();
}

long Report::n_rows() const {
    long n = 0;
    for (const Part& part : m_parts) {
        n += static_cast<long>(part.rows.size());
    }
    return n;
}

void Report::write(const std::string& name, const std::string& text) const {
    std::ofstream out(m_folder / name);
    out << text;
    if (!out.flush()) {
        throw std::runtime_error("cannot write " + (m_folder / name).string());
    }
}

void Report::write_part(const Part& part) const {
    std::vector<std::string> methods; // in the order they first come up, closed forms first
    for (bool closed : {true, false}) {
        for (const Row& row : part.rows) {
            for (const Score& score : row.scores) {
                if (score.is_closed_form == closed &&
                    std::find(methods.begin(), methods.end(), score.method) == methods.end()) {
                    methods.push_back(score.method);
                }
            }
        }
    }
    std::ostringstream page;
    page << "# " << part.title << "\n\n" << part.text << "\n\n";
    for (const std::string& name : part.figures) {
        page << "![" << name << "](" << name << ".svg)\n\n";
    }
    if (!part.rows.empty()) {
        page << "Relative error of held-out motion, unseen loads / unseen kinds of load / unseen clamp; *ratio*: "
                "lowest error of "
                "any closed form over that of trajectory matching, likewise.\n\n";
        page << "| mesh | nodes | springs | material | nu | network | setup |";
        std::string rule = "|---|---|---|---|---|---|---|";
        for (const std::string& method : methods) {
            page << " " << method << " |";
            rule += "---|";
        }
        page << " ratio |\n" << rule << "---|\n";
        for (const Row& row : part.rows) {
            page << "| " << row.mesh << " | " << row.nodes << " | " << row.springs << " | " << row.material << " | "
                 << number(row.poisson) << " | " << row.network << " | " << row.setup << " |";
            for (const std::string& method : methods) {
                const Score* score = row.find(method);
                page << " " << (score == nullptr ? "" : triple(score->errors)) << " |";
            }
            page << " " << (row.find("trajectory") == nullptr ? "" : triple(row.ratio("trajectory"))) << " |\n";
        }
        page << "\n";
    }
    for (const std::string& line : part.notes) {
        page << line << "\n\n";
    }
    page << "All figures: [" << part.id << ".csv](" << part.id << ".csv). [Summary](README.md).\n";
    write(part.id + ".md", page.str());

    std::ostringstream csv;
    csv.precision(6);
    csv << "mesh,nodes,springs,material,poisson,network,setup,method,error_unseen_loads,error_unseen_kinds,"
           "error_unseen_clamp,seconds,note\n";
    for (const Row& row : part.rows) {
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
    write(part.id + ".csv", csv.str());
}

void Report::write_summary() const {
    std::ostringstream page;
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char date[16];
    std::strftime(date, sizeof date, "%Y-%m-%d", &utc);
    page << "# Accuracy study\n\n"
         << "How far the motion of fitted networks is from a reference's that they have not seen, beside every closed "
            "form. Error: "
            "sqrt(sum |x - x_ref|^2 / sum |x_ref - x_rest|^2) over the nodes that are not clamped and all cases of a "
            "set; 0 is "
            "the reference itself, 1 as bad as not moving at all. Each set is drawn by seed and is not seen by any "
            "fit.\n\n"
         << "- Command: `" << m_command << "` (" << (m_is_quick ? "the quick study" : "the full study") << ", "
         << m_state << ")\n- Machine: " << machine() << "\n- Seed: " << m_seed << "\n- Date: " << date
         << "\n\n## Parts\n\n";
    for (const Part& part : m_parts) {
        page << "- [" << part.title << "](" << part.id << ".md), " << part.rows.size() << " rows\n";
    }
    if (!m_bars.empty()) {
        page << "\n## Bars\n\n| what | measured | bar | |\n|---|---|---|---|\n";
        long n_met = 0;
        for (const Bar& bar : m_bars) {
            const bool met = bar.is_upper ? bar.value <= bar.limit : bar.value >= bar.limit;
            n_met += met ? 1 : 0;
            page << "| " << bar.name << " | " << number(bar.value) << " | " << (bar.is_upper ? "<= " : ">= ")
                 << number(bar.limit) << " | "
                 << (std::isnan(bar.value) ? "not measured"
                     : met                 ? "pass"
                                           : "**fail**")
                 << " |\n";
        }
        page << "\n" << n_met << " of " << m_bars.size() << " bars are met.\n";
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
