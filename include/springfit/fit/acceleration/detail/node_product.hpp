// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/execution.hpp>
#include <springfit/fit/acceleration/node_quadratic.hpp>

namespace springfit::detail {

/// H x of a node quadratic, many times over: every term into its own place first, then every unknown sums what its
/// terms have for it, in their order. So terms and unknowns are independent of each other, and the bits do not depend
/// on the number of threads. Memory: about 20 bytes per column of a term.
template <class Objective>
class NodeProduct {
public:
    using Unknowns = typename Objective::Unknowns;

    NodeProduct(const Objective& objective, const Execution& execution)
        : m_objective(objective), m_execution(execution) {
        m_begin.reserve(static_cast<std::size_t>(objective.n_terms()) + 1);
        m_begin.push_back(0);
        for (Index i = 0; i < objective.n_terms(); ++i) {
            m_begin.push_back(m_begin.back() + packed_room(objective.term(i).size()));
        }
        m_image.resize(m_begin.back());
        auto occurrences = objective.occurrences();
        m_first = std::move(occurrences.first);
        m_place.reserve(occurrences.list.size());
        for (const auto& [term, position] : occurrences.list) {
            m_place.push_back(static_cast<int>(m_begin[static_cast<std::size_t>(term)] + position));
        }
    }

    /// result = H x `[n_unknowns]`; returns x'H x.
    double operator()(const Unknowns& x, Unknowns& result) {
        m_execution.for_chunks(m_objective.n_terms(), terms_per_chunk,
                               [&](Index, Index begin, Index end) { multiply(x, begin, end); });
        result.resize(x.size());
        m_partial.resize(Execution::n_chunks(x.size(), unknowns_per_chunk));
        m_execution.for_chunks(x.size(), unknowns_per_chunk, [&](Index chunk, Index begin, Index end) {
            for (Index u = begin; u < end; ++u) {
                double sum = m_objective.ridge()(u) * x(u);
                const Index last = m_first[static_cast<std::size_t>(u) + 1];
                for (Index o = m_first[static_cast<std::size_t>(u)]; o < last; ++o) {
                    sum += m_image(m_place[static_cast<std::size_t>(o)]);
                }
                result(u) = sum;
            }
            m_partial(chunk) = x.segment(begin, end - begin).dot(result.segment(begin, end - begin));
        });
        return m_partial.sum();
    }

private:
    static constexpr Index terms_per_chunk = 512;
    static constexpr Index unknowns_per_chunk = 2048;
    static constexpr Index terms_at_once = 16;

    /// H_i x_i of some terms. What they need of x is gathered for a few of them before they are multiplied: a vector
    /// load right after the scalar stores that it reads would wait for them.
    void multiply(const Unknowns& x, Index begin, Index end) {
        const auto place_of = [this](Index term) { return m_begin[static_cast<std::size_t>(term)]; };
        Index most = 0;
        for (Index first = begin; first < end; first += terms_at_once) {
            most = std::max(most, place_of(std::min(end, first + terms_at_once)) - place_of(first));
        }
        Unknowns gathered(most);
        for (Index first = begin; first < end; first += terms_at_once) {
            const Index last = std::min(end, first + terms_at_once);
            const Index offset = place_of(first);
            double* to = gathered.data();
            for (Index i = first; i < last; ++i) {
                const auto columns = m_objective.term(i).columns;
                for (const int u : columns) {
                    *to++ = x(u);
                }
                for (auto n = static_cast<Index>(columns.size()); n < packed_room(n); ++n) {
                    *to++ = 0;
                }
            }
            for (Index i = first; i < last; ++i) {
                const auto term = m_objective.term(i);
                const Index place = place_of(i);
                packed_product(term.hessian, term.size(), gathered.data() + (place - offset), m_image.data() + place);
            }
        }
    }

    const Objective& m_objective;
    Execution m_execution;
    std::vector<Index> m_begin; ///< per term, its entries of m_image
    Unknowns m_image;           ///< H_i x_i of all terms
    std::vector<Index> m_first; ///< per unknown, its entries of m_place
    std::vector<int> m_place;   ///< what an unknown gets, in m_image
    Unknowns m_partial;         ///< x'H x by chunks of unknowns
};

} // namespace springfit::detail
