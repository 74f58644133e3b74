// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <springfit/core/stopwatch.hpp>

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
    /// Errors of a method; NaN where it was not run.
    [[nodiscard]] Errors errors_of(const std::string& method) const;
    /// Per set of cases, the lowest error of any closed form.
    [[nodiscard]] Errors best_closed_form() const;
    /// Error of the best closed form over that of the method, per set.
    [[nodiscard]] Errors ratio(const std::string& method = "trajectory") const;
};

/// Lines of text in columns, for what rows of errors do not hold.
struct Table {
    std::string name; ///< of its file, `<name>.csv`
    std::string text; ///< above it
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> lines{};
};

/// Two or three digits that count; "fails" for infinity, where a network could not be simulated, a dash for NaN.
[[nodiscard]] std::string number(double value);

/// The tables, figures and bars of a study, written anew after every row, so that what is done is never lost.
class Report {
public:
    /// `command` goes into the summary. Makes the folder. Throws std::runtime_error where that fails.
    Report(std::filesystem::path folder, std::string command, unsigned seed, bool is_quick);

    /// The rows that follow belong to this part, `<id>.md` and `<id>.csv`.
    void begin(const std::string& id, const std::string& title, const std::string& text);
    void add(const Row& row);
    /// A table of the current part; it takes the place of one of the same name.
    void table(const Table& table);
    /// A line of text below the part's tables.
    void note(const std::string& line);
    /// A figure of the current part, `<name>.svg`; it takes the place of one of the same name.
    void figure(const std::string& name, const std::string& svg);
    /// A bar of the summary: the value is to be at most, or at least, the limit. NaN: not measured.
    void at_most(const std::string& name, double value, double limit);
    void at_least(const std::string& name, double value, double limit);
    /// A bar that only a mistake in the program can miss: the study then fails.
    void must_be_at_most(const std::string& name, double value, double limit);
    /// Ends the current part.
    void end_part();
    /// Marks the study as cut short, or as done.
    void end(bool interrupted);

    [[nodiscard]] bool has_failed() const { return m_has_failed; }

private:
    struct Part {
        std::string id, title, text;
        std::vector<Row> rows{};
        std::vector<Table> tables{};
        std::vector<std::string> notes{};
        std::vector<std::string> figures{};
        double seconds = 0;
    };
    struct Bar {
        std::string name;
        double value, limit;
        bool is_upper;
        [[nodiscard]] bool is_met() const { return is_upper ? value <= limit : value >= limit; }
    };

    void write_part(const Part& part) const;
    void write_summary() const;
    void write(const std::string& name, const std::string& text) const;
    [[nodiscard]] std::string bars() const;

    std::filesystem::path m_folder;
    std::string m_command;
    unsigned m_seed;
    bool m_is_quick;
    bool m_has_failed = false;
    std::string m_state = "in progress";
    springfit::Stopwatch m_of_part;
    std::vector<Part> m_parts;
    std::vector<Bar> m_bars;
};

/// Processor, cores and compiler, in words.
[[nodiscard]] std::string machine();

} // namespace study
