// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

/// Line charts and grouped bars as SVG text, without any dependency.
namespace study::svg {

/// A named row of values: of a line its points, of bars one value per group; values that are not finite are left out.
struct Series {
    std::string name;
    std::vector<double> x{}; ///< of lines alone
    std::vector<double> y;
};

struct Chart {
    std::string title{};
    std::string x_label{};
    std::string y_label{};
    bool log_x = false;
    bool log_y = false;
    std::vector<std::string> groups{}; ///< of bars alone
    std::vector<Series> series{};
};

/// One axis: a range of values laid onto a range of pixels, with ticks at round values.
class Axis {
public:
    Axis(double low, double high, bool is_log, double from, double to) : m_is_log(is_log), m_from(from), m_to(to) {
        if (!(low <= high)) { // no value at all
            low = high = 1;
        }
        if (is_log) {
            m_low = std::log10(low);
            m_high = std::log10(high);
        } else {
            m_low = low;
            m_high = high;
        }
        if (!(m_high - m_low > 1e-12 * std::abs(m_high))) {
            m_low -= 0.5;
            m_high += 0.5;
        }
        set_ticks();
    }

    [[nodiscard]] double operator()(double value) const {
        const double v = m_is_log ? std::log10(value) : value;
        return m_from + (m_to - m_from) * std::clamp((v - m_low) / (m_high - m_low), 0., 1.);
    }
    [[nodiscard]] const std::vector<double>& ticks() const { return m_ticks; }

private:
    void set_ticks() {
        if (m_is_log) {
            const bool is_short = m_high - m_low < 2;
            const double margin = 0.05 * (m_high - m_low);
            m_low -= margin;
            m_high += margin;
            for (int decade = static_cast<int>(std::floor(m_low)); decade <= m_high; ++decade) {
                for (double step : {1., 2., 5.}) {
                    const double at = decade + std::log10(step);
                    if ((step == 1. || is_short) && at >= m_low && at <= m_high) {
                        m_ticks.push_back(std::pow(10., at));
                    }
                }
            }
            return;
        }
        const double rough = (m_high - m_low) / 5;
        const double decade = std::pow(10., std::floor(std::log10(rough)));
        const double step =
            decade * (rough < 2 * decade ? (rough < decade * 1.5 ? 1 : 2) : (rough < 4 * decade ? 5 : 10));
        m_low = step * std::floor(m_low / step);
        m_high = step * std::ceil(m_high / step);
        for (int t = 0; m_low + t * step <= m_high + step / 2; ++t) {
            m_ticks.push_back(m_low + t * step);
        }
    }

    bool m_is_log;
    double m_from, m_to;
    double m_low = 0, m_high = 1;
    std::vector<double> m_ticks;
};

namespace detail {

inline constexpr double width = 720, height = 420, left = 70, right = 520, top = 40, bottom = 360;
inline constexpr std::array colours{"#1b6ca8", "#d1495b", "#2e933c", "#edae49", "#6b4c9a",
                                    "#00798c", "#8d5b4c", "#4f4f4f", "#c06bb0", "#9aa33b"};

inline std::string escaped(const std::string& text) {
    std::string result;
    for (char c : text) {
        result += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    }
    return result;
}

inline const char* colour(std::size_t s) {
    return colours[s % colours.size()];
}

inline void put_text(std::ostream& out, double x, double y, const std::string& text, const char* more) {
    out << "<text x=\"" << x << "\" y=\"" << y << "\" " << more << ">" << escaped(text) << "</text>\n";
}

inline std::string tick_text(double value) {
    std::ostringstream text;
    text << (std::abs(value) < 1e-12 ? 0. : value);
    return text.str();
}

/// Lowest and highest of the finite values (on a logarithmic axis, of the positive ones).
inline std::array<double, 2> range(const Chart& chart, std::vector<double> Series::* values, bool is_log) {
    std::array<double, 2> result{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const auto& series : chart.series) {
        for (double value : series.*values) {
            if (std::isfinite(value) && (!is_log || value > 0)) {
                result = {std::min(result[0], value), std::max(result[1], value)};
            }
        }
    }
    return result;
}

inline void begin(std::ostream& out, const Chart& chart, const Axis& y) {
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width << " " << height
        << "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    put_text(out, (left + right) / 2, 22, chart.title, "text-anchor=\"middle\" font-size=\"14\"");
    for (double tick : y.ticks()) {
        out << "<path d=\"M" << left << " " << y(tick) << "H" << right << "\" stroke=\"#ddd\"/>\n";
        put_text(out, left - 6, y(tick) + 4, tick_text(tick), "text-anchor=\"end\"");
    }
    out << "<path d=\"M" << left << " " << top << "V" << bottom << "H" << right
        << "\" fill=\"none\" stroke=\"black\"/>\n";
    put_text(out, (left + right) / 2, height - 18, chart.x_label, "text-anchor=\"middle\"");
    put_text(out, 0, 0, chart.y_label, "text-anchor=\"middle\" transform=\"translate(18 200) rotate(-90)\"");
    for (std::size_t s = 0; s < chart.series.size(); ++s) {
        const double at = top + 10 + 18 * static_cast<double>(s);
        out << "<rect x=\"" << right + 14 << "\" y=\"" << at - 9 << "\" width=\"12\" height=\"10\" fill=\"" << colour(s)
            << "\"/>\n";
        put_text(out, right + 32, at, chart.series[s].name, "");
    }
}

} // namespace detail

/// Lines through the points of each series.
[[nodiscard]] inline std::string lines(const Chart& chart) {
    using namespace detail;
    const auto x_range = range(chart, &Series::x, chart.log_x);
    const auto y_range = range(chart, &Series::y, chart.log_y);
    const Axis x(x_range[0], x_range[1], chart.log_x, left, right);
    const Axis y(chart.log_y ? y_range[0] : std::min(0., y_range[0]), y_range[1], chart.log_y, bottom, top);
    std::ostringstream out;
    out.precision(5);
    begin(out, chart, y);
    for (double tick : x.ticks()) {
        out << "<path d=\"M" << x(tick) << " " << bottom << "v5\" stroke=\"black\"/>\n";
        put_text(out, x(tick), bottom + 18, tick_text(tick), "text-anchor=\"middle\"");
    }
    for (std::size_t s = 0; s < chart.series.size(); ++s) {
        const auto& series = chart.series[s];
        std::ostringstream path, dots;
        for (std::size_t p = 0; p < std::min(series.x.size(), series.y.size()); ++p) {
            const double u = series.x[p];
            const double v = series.y[p];
            if (!std::isfinite(u) || !std::isfinite(v) || (chart.log_x && u <= 0) || (chart.log_y && v <= 0)) {
                continue;
            }
            path << (path.tellp() > 0 ? "L" : "M") << x(u) << " " << y(v);
            dots << "<circle cx=\"" << x(u) << "\" cy=\"" << y(v) << "\" r=\"3\" fill=\"" << colour(s) << "\"/>\n";
        }
        out << "<path d=\"" << path.str() << "\" fill=\"none\" stroke-width=\"2\" stroke=\"" << colour(s) << "\"/>\n"
            << dots.str();
    }
    out << "</svg>\n";
    return out.str();
}

/// For each group, one bar of each series beside the other.
[[nodiscard]] inline std::string bars(const Chart& chart) {
    using namespace detail;
    const auto y_range = range(chart, &Series::y, chart.log_y);
    // On a logarithmic axis, bars begin at half of the lowest value.
    const Axis y(chart.log_y ? y_range[0] / 2 : std::min(0., y_range[0]), y_range[1], chart.log_y, bottom, top);
    std::ostringstream out;
    out.precision(5);
    begin(out, chart, y);
    const double group_width = (right - left) / static_cast<double>(std::max<std::size_t>(1, chart.groups.size()));
    const double bar_width = 0.8 * group_width / static_cast<double>(std::max<std::size_t>(1, chart.series.size()));
    for (std::size_t g = 0; g < chart.groups.size(); ++g) {
        const double begin_at = left + group_width * (static_cast<double>(g) + 0.1);
        put_text(out, begin_at + 0.4 * group_width, bottom + 18, chart.groups[g], "text-anchor=\"middle\"");
        for (std::size_t s = 0; s < chart.series.size(); ++s) {
            const auto& values = chart.series[s].y;
            if (g < values.size() && std::isfinite(values[g]) && (!chart.log_y || values[g] > 0)) {
                const double at = y(values[g]);
                out << "<rect x=\"" << begin_at + bar_width * static_cast<double>(s) << "\" y=\"" << at << "\" width=\""
                    << 0.92 * bar_width << "\" height=\"" << bottom - at << "\" fill=\"" << colour(s) << "\"/>\n";
            }
        }
    }
    out << "</svg>\n";
    return out.str();
}

} // namespace study::svg
