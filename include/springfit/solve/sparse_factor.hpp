// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <concepts>
#include <memory>
#include <vector>

#include <springfit/core/types.hpp>
#include <springfit/solve/detail/supernode.hpp>

namespace springfit {

/// What finds the sparse factor L L' of a `SparseCholesky`: Eigen, or the library of a backend.
class SparseFactor {
public:
    SparseFactor() = default;
    SparseFactor(const SparseFactor&) = delete;
    SparseFactor& operator=(const SparseFactor&) = delete;
    virtual ~SparseFactor() = default;

    /// Operations of a factorisation in the time of one of Eigen's, about.
    [[nodiscard]] virtual double relative_speed() const = 0;

    /// An order of elimination that fills little: the node at each place. `graph` is the lower triangle of a matrix
    /// over the nodes.
    [[nodiscard]] virtual std::vector<int> order(const SparseMatrix<double>& graph) const = 0;

    /// Finds the pattern of L. `lower` is to be eliminated in its own order; its rows ascend in each column.
    virtual void analyse(const SparseMatrix<double>& lower) = 0;

    /// Finds L of a matrix of the pattern that was analysed; false where a pivot is not positive.
    [[nodiscard]] virtual bool factorise(const SparseMatrix<double>& lower) = 0;

    /// L, which stays in place until the next call of the two above; its pattern alone where it is not yet found.
    [[nodiscard]] virtual detail::Supernodes supernodes() const = 0;
};

/// Makes a factor that holds nothing yet; threads may call it at once.
using MakeSparseFactor = std::unique_ptr<SparseFactor> (*)();

namespace detail {
inline std::atomic<MakeSparseFactor> default_sparse_factor = nullptr; ///< of the whole program; none: Eigen's
}

/// Eigen's factor, column by column.
template <std::same_as<double> Scalar = double>
[[nodiscard]] std::unique_ptr<SparseFactor> simplicial_factor();

/// Lets every `SparseCholesky` that the program makes from here on, in any thread, have the factors of `make`; Eigen's
/// for nullptr, as at the start. Those that are there keep theirs.
inline void set_default_sparse_factor(MakeSparseFactor make) {
    detail::default_sparse_factor = make;
}

} // namespace springfit

#include <springfit/solve/detail/simplicial_factor.hpp>
