// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace study {

/// Errors on held-out cases, as `springfit::motion_error`; NaN where a set was not asked for.
struct Errors {
    double loads = std::numeric_limits<double>::quiet_NaN(); ///< unseen loads of the kinds and clamps trained on
    double kinds = std::numeric_limits<double>::quiet_NaN(); ///< unseen kinds of load
    double clamp = std::numeric_limits<double>::quiet_NaN(); ///< an unseen clamp
};

/// How good one method is on one row.
struct Score {
    std::string method;
    bool is_closed_form = false;
    Errors errors;
    double seconds = 0; ///< to find the values; 0 for closed forms
    std::string note{}; ///< how a fit ended, or an extra figure
};

/// One mesh, material, resolution and setup.
struct Row {
    std::string mesh;
    std::string material;
    double poisson = 0;
    long nodes = 0;
    long springs = 0;
    std::string network;
    std::string setup;
    std::vector<Score> scores{};

    /// The score of a method; null where it was not run.
    [[nodiscard]] const Score* find(const std::string& method) const;
    /// Per set of cases, the lowest error of any closed form.
    [[nodiscard]] Errors best_closed_form() const;
    /// Error of the best closed form over that of the method, per set.
    [[nodiscard]] Errors ratio(const std::string& method) const;
};

/// The tables, figures and bars of a study, written anew after every row, so that what is done is never lost.
class Report {
public:
    /// `command` and `machine` go into the summary. Makes the folder. Throws std::runtime_error where that fails.
    Report(std::filesystem::path folder, std::string command, unsigned seed, bool is_quick);

    /// The rows that follow belong to this part, `<id>.md` and `<id>.csv`.
    void begin(const std::string& id, const std::string& title, const std::string& text);
    void add(Row row);
    /// A line of text below the part's table.
    void note(const std::string& line);
    /// A figure of the current part, `<name>.svg`.
    void figure(const std::string& name, const std::string& svg);
    /// A bar of the summary: the value is to be at most, or at least, the limit. NaN: not measured.
    void at_most(const std::string& name, double value, double limit);
    void at_least(const std::string& name, double value, double limit);
    /// Marks the study as cut short, or as done.
    void end(bool interrupted);

    [[nodiscard]] long n_rows() const;
    [[nodiscard]] const std::vector<Row>& rows() const { return m_parts.back().rows; }

private:
    struct Part {
        std::string id, title, text;
        std::vector<Row> rows{};
        std::vector<std::string> notes{};
        std::vector<std::string> figures{};
    };
    struct Bar {
        std::string name;
        double value, limit;
        bool is_upper;
    };

    void write_part(const Part& part) const;
    void write_summary() const;
    void write(const std::string& name, const std::string& text) const;

    std::filesystem::path m_folder;
    std::string m_command;
    unsigned m_seed;
    bool m_is_quick;
    std::string m_state = "in progress";
    std::vector<Part> m_parts;
    std::vector<Bar> m_bars;
};

/// Processor, cores and compiler, in words.
[[nodiscard]] std::string machine();

} // namespace study
