// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <set>

#include <springfit/body/detail/packed_cell.hpp>
#include <springfit/core/execution.hpp>
#include <springfit/solve/locality.hpp>

namespace springfit::detail {

/// A network's springs in the order and layout that a step wants them in.
///
/// Nodes are renumbered by locality and cut into domains of consecutive nodes, as many as the size of
/// the network says. A spring is stored once, with the domain of its two ends; one between two domains is stored with
/// both, each for its own end, so that domains can be worked on by different threads and no sum depends on how
/// many there are. Springs are sorted by their lower end and stored in blocks, one lane per spring.
template <int Dim, std::floating_point Scalar>
class PackedSprings {
public:
    static constexpr int lanes = 32 / static_cast<int>(sizeof(Scalar)); ///< springs per block
    static constexpr int blocks_per_chunk = 64 / lanes;
    static constexpr std::ptrdiff_t blocks_ahead = 128 / lanes; ///< how far ahead of its use a block is asked for
    static constexpr Index nodes_per_domain = 16384;

    /// Values that stand side by side for as many springs; springs that fill up a block have none and two equal ends.
    struct alignas(32) Block {
        int first[lanes]; ///< the lower end; the own one of a spring between domains
        int second[lanes];
        Scalar stiffness[lanes]; ///< k
        Scalar pull[lanes];      ///< k l
        Scalar damping[lanes];   ///< c
    };

    struct Domain {
        int begin = 0, end = 0;                     ///< its nodes
        std::vector<Block> inner, border;           ///< springs within it, and from it to others
        std::vector<PackedCell<Dim, Scalar>> cells; ///< with a corner in it
    };

    explicit PackedSprings(const SpringNetwork<Dim, Scalar>& network)
        : m_order(locality_order(network.n_nodes(), network.springs)), m_number(m_order.size()) {
        for (std::size_t place = 0; place < m_order.size(); ++place) {
            m_number[static_cast<std::size_t>(m_order[place])] = static_cast<int>(place);
        }
        const Index n = network.n_nodes();
        const Index n_domains = std::max<Index>(1, Execution::n_chunks(n, nodes_per_domain));
        m_domains.resize(static_cast<std::size_t>(n_domains));
        for (Index d = 0; d < n_domains; ++d) {
            m_domains[static_cast<std::size_t>(d)].begin = static_cast<int>(n * d / n_domains);
            m_domains[static_cast<std::size_t>(d)].end = static_cast<int>(n * (d + 1) / n_domains);
        }
        add_springs(network);
        add_cells(network);
    }

    [[nodiscard]] const std::vector<Domain>& domains() const { return m_domains; }
    [[nodiscard]] const std::vector<int>& order() const { return m_order; } ///< the network's node at each place
    [[nodiscard]] int number(int node) const { return m_number[static_cast<std::size_t>(node)]; }
    [[nodiscard]] Index n_nodes() const { return static_cast<Index>(m_order.size()); }

    [[nodiscard]] std::size_t domain_of(int place) const {
        const auto after = std::upper_bound(m_domains.begin(), m_domains.end(), place,
                                            [](int own, const Domain& domain) { return own < domain.begin; });
        return static_cast<std::size_t>(after - m_domains.begin()) - 1;
    }

private:
    /// A spring as it is sorted: its ends, lower first or own first, and its number.
    struct Entry {
        std::uint64_t ends;
        int spring;
        bool operator<(const Entry& other) const { return ends < other.ends; }
    };

    static Entry entry(int first, int second, Index spring) {
        return {static_cast<std::uint64_t>(first) << 32 | static_cast<std::uint64_t>(second), static_cast<int>(spring)};
    }

    void add_springs(const SpringNetwork<Dim, Scalar>& network) {
        std::vector<std::vector<Entry>> inner(m_domains.size()), border(m_domains.size());
        for (Index e = 0; e < network.n_springs(); ++e) {
            const int a = number(network.springs(0, e));
            const int b = number(network.springs(1, e));
            const std::size_t at_a = domain_of(a);
            const std::size_t at_b = domain_of(b);
            if (at_a == at_b) {
                inner[at_a].push_back(entry(std::min(a, b), std::max(a, b), e));
            } else {
                border[at_a].push_back(entry(a, b, e));
                border[at_b].push_back(entry(b, a, e));
            }
        }
        for (std::size_t d = 0; d < m_domains.size(); ++d) {
            m_domains[d].inner = blocks(network, inner[d], m_domains[d].begin);
            m_domains[d].border = blocks(network, border[d], m_domains[d].begin);
        }
    }

    /// Springs that follow each other in memory share no end as a rule: within a chunk they come from four places of
    /// the sorted list in turn. A sum at a node then does not wait for the one before it.
    static std::vector<Block> blocks(const SpringNetwork<Dim, Scalar>& network, std::vector<Entry>& entries, int idle) {
        std::sort(entries.begin(), entries.end());
        const std::size_t n = entries.size();
        std::vector<Block> result((n + lanes - 1) / lanes);
        constexpr std::size_t per_chunk = static_cast<std::size_t>(lanes * blocks_per_chunk);
        for (std::size_t begin = 0; begin < n; begin += per_chunk) {
            const std::size_t padded = std::min(per_chunk, result.size() * lanes - begin);
            for (std::size_t p = 0; p < padded; ++p) {
                const std::size_t source = begin + p % 4 * (padded / 4) + p / 4;
                Block& block = result[(begin + p) / lanes];
                const std::size_t lane = p % lanes;
                if (source < n) {
                    const Index e = entries[source].spring;
                    block.first[lane] = static_cast<int>(entries[source].ends >> 32);
                    block.second[lane] = static_cast<int>(entries[source].ends & 0xffffffffu);
                    block.stiffness[lane] = network.stiffness(e);
                    block.pull[lane] = network.stiffness(e) * network.rest_length(e);
                    block.damping[lane] = network.damping(e);
                } else {
                    block.first[lane] = block.second[lane] = idle;
                    block.stiffness[lane] = block.pull[lane] = block.damping[lane] = 0;
                }
            }
        }
        return result;
    }

    /// A cell is stored with each domain that it has a corner in, each for its own corners.
    void add_cells(const SpringNetwork<Dim, Scalar>& network) {
        for (const auto& cell : packed_cells(network, [&](int node) { return number(node); })) {
            std::set<std::size_t> domains;
            for (const int corner : cell.corners) {
                domains.insert(domain_of(corner));
            }
            for (const std::size_t d : domains) {
                m_domains[d].cells.push_back(cell);
            }
        }
    }

    std::vector<int> m_order, m_number;
    std::vector<Domain> m_domains;
};

} // namespace springfit::detail
