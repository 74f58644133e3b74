// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numeric>
#include <span>

#include <springfit/core/execution.hpp>
#include <springfit/core/lanes.hpp>
#include <springfit/fit/acceleration/node_quadratic.hpp>
#include <springfit/solve/locality.hpp>

namespace springfit::detail {

/// The Hessian of a node quadratic, scaled to a diagonal of 1 and split for sweeps of Gauss and Seidel:
///
///     diag(H)^-1/2 H diag(H)^-1/2 + (d - 1) I = W + W' - d I ,   W = d I + L ,   L strictly lower.
///
/// Unknowns have places of their own here: by colour first, two that share a term never having the same, and by
/// locality within one. The rows of a colour do not depend on each other, so they are worked on by lanes and by
/// threads, and the bits do not depend on how many threads there are. Vectors are `[size()]` by place and finite;
/// places that no unknown has, and unknowns that are not free, are 0 in solutions. Memory: an index and a number,
/// twice, for each two unknowns that share a term.
template <std::floating_point Scalar>
class SymmetricGaussSeidel {
public:
    /// `curvature` is the diagonal of H.
    SymmetricGaussSeidel(const NodeQuadratic& objective, const Values<double>& curvature, const Execution& execution)
        : m_execution(execution) {
        const NodeQuadratic::Occurrences occurrences = objective.occurrences();
        const std::vector<int> terms = order_of_terms(objective, occurrences);
        choose_places(objective, occurrences, terms);
        m_scale = (curvature.array() > 0).select(curvature.array().rsqrt(), 0.);
        m_free = Values<Scalar>::Zero(size());
        fill(objective, terms);
    }

    /// Places.
    [[nodiscard]] Index size() const { return m_colours.back(); }
    /// Entries of L.
    [[nodiscard]] Index n_entries() const { return static_cast<Index>(m_lower.values.size()); }

    /// From now on the unknowns move whose `weight` is not 0. Writes unit^-1 diag(H)^-1/2 times their gradient, and 0
    /// for the others; `weight` and `gradient` are in the order of the unknowns.
    void gather(const Values<double>& weight, const Values<double>& gradient, double unit, Values<Scalar>& by_place) {
        by_place.setZero(size());
        for (Index u = 0; u < weight.size(); ++u) {
            const bool free = weight(u) > 0;
            m_free(place(u)) = free ? Scalar(1) : Scalar(0);
            by_place(place(u)) = free ? static_cast<Scalar>(m_scale(u) * gradient(u) / unit) : Scalar(0);
        }
    }

    /// step = unit diag(H)^-1/2 by_place, in the order of the unknowns.
    void scatter(const Values<Scalar>& by_place, double unit, Values<double>& step) const {
        step.resize(m_scale.size());
        for (Index u = 0; u < step.size(); ++u) {
            step(u) = unit * m_scale(u) * static_cast<double>(by_place(place(u)));
        }
    }

    /// Inner products that a solve accumulates.
    struct Sums {
        double xb = 0; ///< x' b
        double xx = 0; ///< x' x
    };

    /// W x = b for the free unknowns, by increasing place; `right_side(place)` gives as many entries of b from there on
    /// as there are lanes.
    template <class RightSide>
    void solve_lower(Scalar diagonal, const RightSide& right_side, Values<Scalar>& x) {
        for (std::size_t c = 0; c + 1 < m_colours.size(); ++c) {
            solve(m_lower, c, diagonal, right_side, x);
        }
    }

    /// W' x = b for the free unknowns, by decreasing place.
    template <class RightSide>
    Sums solve_upper(Scalar diagonal, const RightSide& right_side, Values<Scalar>& x) {
        Sums total;
        for (std::size_t c = m_colours.size() - 1; c-- > 0;) {
            const Sums sums = solve(m_upper, c, diagonal, right_side, x);
            total.xb += sums.xb;
            total.xx += sums.xx;
        }
        return total;
    }

    static constexpr Index lanes = 64 / static_cast<Index>(sizeof(Scalar));
    using Lanes = detail::Lanes<Scalar, static_cast<int>(lanes)>;

private:
    static constexpr Index slices_per_chunk = 64;

    /// One triangle in slices of rows side by side, all as long as the longest of them. Two unknowns that share several
    /// terms have an entry for each.
    struct Triangle {
        std::vector<Index> begin; ///< of each slice
        std::vector<int> places;
        std::vector<Scalar> values;
    };

    [[nodiscard]] Index place(Index unknown) const { return m_places[static_cast<std::size_t>(unknown)]; }

    template <class RightSide>
    Sums solve(const Triangle& triangle, std::size_t colour, Scalar diagonal, const RightSide& right_side,
               Values<Scalar>& x) {
        const Scalar inverse = 1 / diagonal;
        const Index first = m_colours[colour] / lanes;
        const Index n_slices = m_colours[colour + 1] / lanes - first;
        m_partial.resize(static_cast<std::size_t>(Execution::n_chunks(n_slices, slices_per_chunk)));
        m_execution.for_chunks(n_slices, slices_per_chunk, [&](Index chunk, Index begin, Index end) {
            Lanes xb = Scalar(0);
            Lanes xx = Scalar(0);
            for (Index slice = first + begin; slice < first + end; ++slice) {
                const auto from = static_cast<std::size_t>(triangle.begin[static_cast<std::size_t>(slice)]);
                const auto to = static_cast<std::size_t>(triangle.begin[static_cast<std::size_t>(slice) + 1]);
                const Scalar* values = triangle.values.data() + from;
                Lanes product = Scalar(0);
                for (const int* places = triangle.places.data() + from; places != triangle.places.data() + to;
                     places += lanes, values += lanes) {
                    Lanes there;
                    for (int l = 0; l < lanes; ++l) {
                        there(l) = x.data()[places[l]];
                    }
                    product += Lanes::at(values) * there;
                }
                const Lanes b = right_side(slice * lanes);
                const Lanes own = inverse * Lanes::at(m_free.data() + slice * lanes) * (b - product);
                Lanes::at(x.data() + slice * lanes) = own;
                xb += own * b;
                xx += own * own;
            }
            m_partial[static_cast<std::size_t>(chunk)] = {std::accumulate(xb.lane, xb.lane + lanes, 0.),
                                                          std::accumulate(xx.lane, xx.lane + lanes, 0.)};
        });
        Sums total;
        for (const Sums& sums : m_partial) {
            total.xb += sums.xb;
            total.xx += sums.xx;
        }
        return total;
    }

    /// Colours as they come: each unknown, by locality, gets the first that no other of its terms has.
    void choose_places(const NodeQuadratic& objective, const NodeQuadratic::Occurrences& occurrences,
                       const std::vector<int>& terms) {
        const Index n = objective.n_unknowns();
        std::vector<std::vector<int>> colours(1); // the unknowns of each
        std::vector<int> colour_of(static_cast<std::size_t>(n), -1);
        std::vector<int> taken; // per colour, the unknown that last found it taken
        const auto colour = [&](int u) {
            taken.resize(colours.size() + 1, -1);
            for (const auto& [i, position] : occurrences.of(u)) {
                for (const int other : objective.term(i).columns) {
                    if (const int theirs = colour_of[static_cast<std::size_t>(other)]; theirs >= 0) {
                        taken[static_cast<std::size_t>(theirs)] = u;
                    }
                }
            }
            const auto free = std::find_if(taken.begin(), taken.end(), [u](int by) { return by != u; });
            const auto own = static_cast<std::size_t>(free - taken.begin());
            colours.resize(std::max(colours.size(), own + 1));
            colours[own].push_back(u);
            colour_of[static_cast<std::size_t>(u)] = static_cast<int>(own);
        };
        for (const int i : terms) {
            for (const int u : objective.term(i).columns) {
                if (colour_of[static_cast<std::size_t>(u)] < 0) {
                    colour(u);
                }
            }
        }
        m_places.resize(static_cast<std::size_t>(n));
        m_colours.push_back(0);
        for (Index u = 0; u < n; ++u) { // those of no term
            if (colour_of[static_cast<std::size_t>(u)] < 0) {
                colours.front().push_back(static_cast<int>(u));
            }
        }
        for (const auto& unknowns : colours) {
            int next = static_cast<int>(m_colours.back());
            for (const int u : unknowns) {
                m_places[static_cast<std::size_t>(u)] = next++;
            }
            m_colours.push_back((next + lanes - 1) / lanes * lanes);
        }
    }

    /// Terms as a wave that runs through them reaches them.
    static std::vector<int> order_of_terms(const NodeQuadratic& objective,
                                           const NodeQuadratic::Occurrences& occurrences) {
        NodePairs joined(2, objective.n_columns());
        Index n_joined = 0;
        for (Index u = 0; u < objective.n_unknowns(); ++u) {
            const auto own = occurrences.of(u);
            for (std::size_t o = 1; o < own.size(); ++o) {
                joined.col(n_joined++) << own[o - 1].term, own[o].term;
            }
        }
        return locality_order(objective.n_terms(), joined.leftCols(n_joined));
    }

    /// Both triangles: what each term has for each two of its unknowns.
    void fill(const NodeQuadratic& objective, const std::vector<int>& terms) {
        struct Row {
            int place;
            Index position; // in the term
            double scale;
        };
        std::vector<Row> rows; // of a term, by place
        const auto for_terms = [&](const auto& take) {
            for (const int i : terms) {
                const auto term = objective.term(i);
                rows.clear();
                for (Index p = 0; p < term.size(); ++p) {
                    const int u = term.columns[static_cast<std::size_t>(p)];
                    rows.push_back({static_cast<int>(place(u)), p, m_scale(u)});
                }
                std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.place < b.place; });
                take(term);
            }
        };
        std::vector<Index> lower(static_cast<std::size_t>(size()), 0); // entries of each row, then where the next goes
        std::vector<Index> upper = lower;
        for_terms([&](const NodeQuadratic::Term&) {
            for (std::size_t p = 0; p < rows.size(); ++p) {
                lower[static_cast<std::size_t>(rows[p].place)] += static_cast<Index>(p);
                upper[static_cast<std::size_t>(rows[p].place)] += static_cast<Index>(rows.size() - 1 - p);
            }
        });
        make_room(lower, m_lower);
        make_room(upper, m_upper);
        for_terms([&](const NodeQuadratic::Term& term) {
            for (std::size_t p = 0; p < rows.size(); ++p) {
                const Row& own = rows[p];
                const auto add = [&](const Row& other, Triangle& triangle, Index& next) {
                    const auto at = static_cast<std::size_t>(next);
                    triangle.places[at] = other.place;
                    triangle.values[at] =
                        static_cast<Scalar>(own.scale * other.scale * term.entry(own.position, other.position));
                    next += lanes;
                };
                for (std::size_t q = 0; q < p; ++q) {
                    add(rows[q], m_lower, lower[static_cast<std::size_t>(own.place)]);
                }
                for (std::size_t q = p + 1; q < rows.size(); ++q) {
                    add(rows[q], m_upper, upper[static_cast<std::size_t>(own.place)]);
                }
            }
        });
        fill_up(lower, m_lower);
        fill_up(upper, m_upper);
    }

    /// Slices for rows of so many entries; in their place comes where the first of each goes.
    static void make_room(std::vector<Index>& rows, Triangle& triangle) {
        triangle.begin.assign(1, 0);
        for (auto row = rows.begin(); row != rows.end(); row += lanes) {
            const Index begin = triangle.begin.back();
            triangle.begin.push_back(begin + lanes * *std::max_element(row, row + lanes));
            std::iota(row, row + lanes, begin);
        }
        triangle.places.resize(static_cast<std::size_t>(triangle.begin.back()));
        triangle.values.resize(triangle.places.size());
    }

    /// Rows shorter than their slice, from `next` on, get entries of 0 that look at themselves.
    static void fill_up(const std::vector<Index>& next, Triangle& triangle) {
        for (std::size_t row = 0; row < next.size(); ++row) {
            for (Index at = next[row]; at < triangle.begin[row / lanes + 1]; at += lanes) {
                triangle.places[static_cast<std::size_t>(at)] = static_cast<int>(row);
            }
        }
    }

    Execution m_execution;
    std::vector<int> m_places;    ///< of the unknowns
    std::vector<Index> m_colours; ///< the place where each begins, and the last ends
    Triangle m_lower, m_upper;    ///< L and L'
    Values<double> m_scale;       ///< diag(H)^-1/2, by unknown
    Values<Scalar> m_free;        ///< 1 or 0, by place
    std::vector<Sums> m_partial;  ///< by chunk of slices
};

} // namespace springfit::detail
