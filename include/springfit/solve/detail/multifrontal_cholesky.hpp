// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>

#include <springfit/solve/multifrontal_cholesky.hpp>

namespace springfit {

inline void MultifrontalCholesky::analyse(const SparseMatrix<double>& lower) {
    order(lower);
    Tree tree;
    find_parents(row_patterns(lower), tree);
    // Again in post-order, so that a supernode's columns follow each other and children come right before their parent.
    const auto n = static_cast<int>(size());
    std::vector<int> first_child(m_place.size(), -1);
    std::vector<int> sibling(m_place.size(), -1);
    for (int c = n - 1; c >= 0; --c) {
        if (const int parent = tree.parent[static_cast<std::size_t>(c)]; parent >= 0) {
            sibling[static_cast<std::size_t>(c)] = first_child[static_cast<std::size_t>(parent)];
            first_child[static_cast<std::size_t>(parent)] = c;
        }
    }
    std::vector<int> post(m_place.size());
    std::vector<int> path;
    int next = 0;
    for (int root = 0; root < n; ++root) {
        if (tree.parent[static_cast<std::size_t>(root)] >= 0) {
            continue;
        }
        path.push_back(root);
        while (!path.empty()) {
            int& child = first_child[static_cast<std::size_t>(path.back())];
            if (child >= 0) {
                path.push_back(child);
                child = sibling[static_cast<std::size_t>(child)];
            } else {
                post[static_cast<std::size_t>(path.back())] = next++;
                path.pop_back();
            }
        }
    }
    for (int& place : m_place) {
        place = post[static_cast<std::size_t>(place)];
    }
    const auto rows = row_patterns(lower);
    find_parents(rows, tree);
    count_rows(rows, tree);
    find_supernodes(tree);
    find_rows(lower, tree);
}

inline void MultifrontalCholesky::order(const SparseMatrix<double>& lower) {
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
    Eigen::AMDOrdering<int> amd;
    amd(lower.selfadjointView<Eigen::Lower>(), permutation); // column k of the permuted matrix is column indices(k)
    m_place.resize(static_cast<std::size_t>(lower.cols()));
    for (int k = 0; k < permutation.size(); ++k) {
        m_place[static_cast<std::size_t>(permutation.indices()(k))] = k;
    }
}

/// Columns left of the diagonal in every row of the permuted matrix.
inline std::vector<std::vector<int>> MultifrontalCholesky::row_patterns(const SparseMatrix<double>& lower) const {
    std::vector<std::vector<int>> rows(m_place.size());
    for (int c = 0; c < lower.outerSize(); ++c) {
        for (SparseMatrix<double>::InnerIterator entry(lower, c); entry; ++entry) {
            const int a = m_place[static_cast<std::size_t>(entry.row())];
            const int b = m_place[static_cast<std::size_t>(c)];
            if (a != b) {
                rows[static_cast<std::size_t>(std::max(a, b))].push_back(std::min(a, b));
            }
        }
    }
    return rows;
}

/// Each row's columns climb to their roots so far, on shortcuts that are kept; the roots become children of the row.
inline void MultifrontalCholesky::find_parents(const std::vector<std::vector<int>>& rows, Tree& tree) {
    tree.parent.assign(rows.size(), -1);
    std::vector<int> shortcut(rows.size(), -1);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const auto r = static_cast<int>(row);
        for (int c : rows[row]) {
            while (c >= 0 && c < r) {
                int& up = shortcut[static_cast<std::size_t>(c)];
                const int above = up;
                up = r;
                if (above < 0) {
                    tree.parent[static_cast<std::size_t>(c)] = r;
                }
                c = above;
            }
        }
    }
}

/// A row of L has an entry in every column on the paths from its entries in A up to itself.
inline void MultifrontalCholesky::count_rows(const std::vector<std::vector<int>>& rows, Tree& tree) {
    tree.count.assign(rows.size(), 1);
    std::vector<int> seen(rows.size(), -1);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const auto r = static_cast<int>(row);
        seen[row] = r;
        for (int c : rows[row]) {
            for (; seen[static_cast<std::size_t>(c)] != r; c = tree.parent[static_cast<std::size_t>(c)]) {
                seen[static_cast<std::size_t>(c)] = r;
                ++tree.count[static_cast<std::size_t>(c)];
            }
        }
    }
}

/// A column joins the supernode before it where that is its child and has the same rows. Then supernodes join their
/// parent, which follows, where this stores few zeros or the two are narrow.
inline void MultifrontalCholesky::find_supernodes(const Tree& tree) {
    struct Range {
        int first, width, rows;
        double zeros;
    };
    const auto parent_of = [&](const Range& range) {
        return tree.parent[static_cast<std::size_t>(range.first + range.width - 1)];
    };
    std::vector<Range> ranges;
    const auto n = static_cast<int>(size());
    for (int c = 0; c < n; ++c) {
        const int count = tree.count[static_cast<std::size_t>(c)];
        if (!ranges.empty() && parent_of(ranges.back()) == c && ranges.back().rows - ranges.back().width == count) {
            ++ranges.back().width;
            continue;
        }
        ranges.push_back({c, 1, count, 0});
    }
    // From the last to the first: a range's parent, where it follows, is complete by then, at the back of `merged`.
    std::vector<Range> merged;
    for (auto range = ranges.rbegin(); range != ranges.rend(); ++range) {
        if (!merged.empty() && parent_of(*range) == merged.back().first) {
            Range& parent = merged.back();
            const int width = range->width + parent.width;
            const int rows = range->width + parent.rows;
            const double zeros = range->zeros + parent.zeros + static_cast<double>(range->width) * (rows - range->rows);
            const double share = zeros / (static_cast<double>(width) * (rows - 0.5 * width));
            if (width <= 8 || share < (width <= 32 ? 0.3 : 0.08)) {
                parent = {range->first, width, rows, zeros};
                continue;
            }
        }
        merged.push_back(*range);
    }
    std::reverse(merged.begin(), merged.end());
    m_supernodes.assign(merged.size(), {});
    m_n_entries = 0;
    m_flops = 0;
    for (std::size_t s = 0; s < merged.size(); ++s) {
        m_supernodes[s].first = merged[s].first;
        m_supernodes[s].width = merged[s].width;
        const double w = merged[s].width;
        const double below = merged[s].rows - w;
        m_n_entries += w * (w + 1) / 2 + w * below;
        m_flops += w * w * w / 3 + w * w * below + w * below * below;
    }
}

/// The rows of every supernode, where its entries lie, and how it hands on to its parent.
inline void MultifrontalCholesky::find_rows(const SparseMatrix<double>& lower, const Tree& tree) {
    std::vector<int> owner(m_place.size());
    for (std::size_t s = 0; s < m_supernodes.size(); ++s) {
        std::fill_n(owner.begin() + m_supernodes[s].first, m_supernodes[s].width, static_cast<int>(s));
    }
    std::vector<std::vector<std::pair<int, int>>> cells(m_supernodes.size()); // row and column, beside `entries`
    for (int c = 0, e = 0; c < lower.outerSize(); ++c) {
        for (SparseMatrix<double>::InnerIterator entry(lower, c); entry; ++entry, ++e) {
            const auto [column, row] =
                std::minmax(m_place[static_cast<std::size_t>(entry.row())], m_place[static_cast<std::size_t>(c)]);
            const auto s = static_cast<std::size_t>(owner[static_cast<std::size_t>(column)]);
            m_supernodes[s].entries.push_back(e);
            cells[s].emplace_back(row, column);
        }
    }
    std::vector<int> seen(m_place.size(), -1);
    std::vector<int> place(m_place.size(), 0);
    for (std::size_t s = 0; s < m_supernodes.size(); ++s) {
        Supernode& node = m_supernodes[s];
        const auto add = [&](int row) {
            if (row >= node.first + node.width && seen[static_cast<std::size_t>(row)] != static_cast<int>(s)) {
                seen[static_cast<std::size_t>(row)] = static_cast<int>(s);
                node.rows.push_back(row);
            }
        };
        for (const auto& [row, column] : cells[s]) {
            add(row);
        }
        for (int child : node.children) {
            for (int row : m_supernodes[static_cast<std::size_t>(child)].rows) {
                add(row);
            }
        }
        std::sort(node.rows.begin(), node.rows.end());
        std::vector<int> own(static_cast<std::size_t>(node.width));
        std::iota(own.begin(), own.end(), node.first);
        node.rows.insert(node.rows.begin(), own.begin(), own.end());
        for (std::size_t r = 0; r < node.rows.size(); ++r) {
            place[static_cast<std::size_t>(node.rows[r])] = static_cast<int>(r);
        }
        for (const auto& [row, column] : cells[s]) {
            node.places.push_back(place[static_cast<std::size_t>(row)] + (column - node.first) * node.n_rows());
        }
        for (int c : node.children) {
            Supernode& child = m_supernodes[static_cast<std::size_t>(c)];
            for (auto row = child.rows.begin() + child.width; row != child.rows.end(); ++row) {
                child.to.push_back(place[static_cast<std::size_t>(*row)]);
            }
        }
        if (const int parent = tree.parent[static_cast<std::size_t>(node.first + node.width - 1)]; parent >= 0) {
            m_supernodes[static_cast<std::size_t>(owner[static_cast<std::size_t>(parent)])].children.push_back(
                static_cast<int>(s));
        }
    }
}

inline bool MultifrontalCholesky::factorise(const SparseMatrix<double>& lower) {
    for (Supernode& node : m_supernodes) {
        if (!eliminate(lower, node)) {
            for (Supernode& other : m_supernodes) {
                other.left.resize(0, 0);
            }
            return false;
        }
    }
    return true;
}

inline bool MultifrontalCholesky::eliminate(const SparseMatrix<double>& lower, Supernode& node) {
    const Index width = node.width;
    const Index below = node.below();
    node.l.setZero(node.n_rows(), width);
    node.left.setZero(below, below);
    for (std::size_t e = 0; e < node.entries.size(); ++e) {
        node.l.data()[node.places[e]] += lower.valuePtr()[node.entries[e]];
    }
    for (int c : node.children) {
        Supernode& child = m_supernodes[static_cast<std::size_t>(c)];
        const auto n = static_cast<Index>(child.to.size());
        for (Index q = 0; q < n; ++q) {
            const int column = child.to[static_cast<std::size_t>(q)];
            const double* from = child.left.data() + q * n;
            double* const into = column < width ? node.l.data() + column * node.n_rows()
                                                : node.left.data() + (column - width) * below - width;
            for (Index p = q; p < n; ++p) {
                into[child.to[static_cast<std::size_t>(p)]] += from[p];
            }
        }
        child.left.resize(0, 0);
    }
    auto own = node.l.topRows(width);
    Eigen::Ref<DenseMatrix<double>, 0, Eigen::OuterStride<>> diagonal(own);
    if (Eigen::LLT<Eigen::Ref<DenseMatrix<double>, 0, Eigen::OuterStride<>>>(diagonal).info() != Eigen::Success) {
        return false;
    }
    if (below > 0) {
        auto rest = node.l.bottomRows(below);
        own.template triangularView<Eigen::Lower>().transpose().template solveInPlace<Eigen::OnTheRight>(rest);
        node.left.template selfadjointView<Eigen::Lower>().rankUpdate(rest, -1.);
    }
    return true;
}

inline void MultifrontalCholesky::solve(const Values<double>& b, Values<double>& x) const {
    Values<double> work(b.size());
    for (Index u = 0; u < b.size(); ++u) {
        work(m_place[static_cast<std::size_t>(u)]) = b(u);
    }
    Values<double> part;
    for (const Supernode& node : m_supernodes) {
        auto own = work.segment(node.first, node.width);
        node.l.topRows(node.width).triangularView<Eigen::Lower>().solveInPlace(own);
        part.noalias() = node.l.bottomRows(node.below()) * own;
        for (Index p = 0; p < node.below(); ++p) {
            work(node.rows[static_cast<std::size_t>(node.width + p)]) -= part(p);
        }
    }
    for (auto node = m_supernodes.rbegin(); node != m_supernodes.rend(); ++node) {
        part.resize(node->below());
        for (Index p = 0; p < node->below(); ++p) {
            part(p) = work(node->rows[static_cast<std::size_t>(node->width + p)]);
        }
        auto own = work.segment(node->first, node->width);
        own.noalias() -= node->l.bottomRows(node->below()).transpose() * part;
        node->l.topRows(node->width).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
    }
    x.resize(b.size());
    for (Index u = 0; u < b.size(); ++u) {
        x(u) = work(m_place[static_cast<std::size_t>(u)]);
    }
}

} // namespace springfit
