// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <mutex>
#include <new>

#include <Eigen/CholmodSupport>

#include <springfit/core/types.hpp>
#include <springfit/solve/detail/supernode.hpp>

// Of OpenMP, which CHOLMOD's library brings along; its header would come with a compiler's flag.
extern "C" {
int omp_get_max_active_levels();
void omp_set_max_active_levels(int levels);
}

namespace springfit::detail {

/// While it lives, one thread at a time uses CHOLMOD, and CHOLMOD one thread: a BLAS library need not be safe to call
/// from several, and CHOLMOD's own, four whatever the machine has free, cost more in small loops than they give.
class CholmodTurn {
public:
    CholmodTurn() : m_lock(s_mutex), m_levels(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
    ~CholmodTurn() { omp_set_max_active_levels(m_levels); }
    CholmodTurn(const CholmodTurn&) = delete;
    CholmodTurn& operator=(const CholmodTurn&) = delete;

private:
    static inline std::mutex s_mutex;
    std::lock_guard<std::mutex> m_lock;
    int m_levels;
};

/// A sparse Cholesky factor that CHOLMOD finds, supernode by supernode with dense kernels from BLAS. Factorisations in
/// several threads wait for each other.
class SupernodalFactor {
public:
    static constexpr double relative_speed = 10; ///< with a fast BLAS

    /// An order of elimination that fills little, by minimum degree or nested dissection: the node at each place.
    /// `graph` is the lower triangle of a matrix over the nodes.
    [[nodiscard]] static std::vector<int> order(const SparseMatrix<double>& graph) {
        const CholmodTurn turn;
        Library library;
        library.cholmod().nmethods = 2; // the one that fills less
        library.cholmod().method[0].ordering = CHOLMOD_AMD;
        library.cholmod().method[1].ordering = CHOLMOD_METIS;
        library.analyzePattern(graph);
        library.require_memory();
        const int* order = static_cast<const int*>(library.factor().Perm);
        return {order, order + graph.cols()};
    }

    /// `lower` is to be eliminated in its own order; its rows ascend in each column.
    void analyse(const SparseMatrix<double>& lower) {
        const CholmodTurn turn;
        m_library = std::make_unique<Library>();
        m_library->cholmod().nmethods = 1;
        m_library->cholmod().method[0].ordering = CHOLMOD_NATURAL;
        m_library->cholmod().postorder = 0;
        m_library->analyzePattern(lower);
        m_library->require_memory();
    }

    /// False where a pivot is not positive.
    [[nodiscard]] bool factorise(const SparseMatrix<double>& lower) {
        const CholmodTurn turn;
        m_library->factorize(lower);
        m_library->require_memory();
        return m_library->info() == Eigen::Success;
    }

    [[nodiscard]] int n_supernodes() const { return static_cast<int>(m_library->factor().nsuper); }

    [[nodiscard]] Supernode supernode(int s) const {
        const cholmod_factor& l = m_library->factor();
        const int* first_column = static_cast<const int*>(l.super) + s;
        const int* first_row = static_cast<const int*>(l.pi) + s;
        return {first_column[1] - first_column[0], first_row[1] - first_row[0],
                static_cast<const int*>(l.s) + first_row[0],
                static_cast<const double*>(l.x) + static_cast<const int*>(l.px)[s]};
    }

private:
    struct Library : Eigen::CholmodSupernodalLLT<SparseMatrix<double>, Eigen::Lower> {
        Library() { this->cholmod().print = 0; }
        [[nodiscard]] const cholmod_factor& factor() const { return *this->m_cholmodFactor; }
        void require_memory() {
            if (this->cholmod().status < CHOLMOD_OK) {
                throw std::bad_alloc();
            }
        }
    };
    std::unique_ptr<Library> m_library;
};

} // namespace springfit::detail
