// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <mutex>
#include <new>

#include <Eigen/CholmodSupport>

#include <springfit/core/types.hpp>
#include <springfit/solve/sparse_factor.hpp>

// Of OpenMP, which CHOLMOD's library brings along; its header would come with a compiler's flag.
extern "C" {
int omp_get_max_active_levels();
void omp_set_max_active_levels(int levels);
}

namespace springfit::cholmod {

namespace detail {

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
class SupernodalFactor final : public SparseFactor {
public:
    /// With a fast BLAS.
    [[nodiscard]] double relative_speed() const override { return 10; }

    /// By minimum degree or nested dissection.
    [[nodiscard]] std::vector<int> order(const SparseMatrix<double>& graph) const override {
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

    void analyse(const SparseMatrix<double>& lower) override {
        const CholmodTurn turn;
        m_library = std::make_unique<Library>();
        m_library->cholmod().nmethods = 1;
        m_library->cholmod().method[0].ordering = CHOLMOD_NATURAL;
        m_library->cholmod().postorder = 0;
        m_library->analyzePattern(lower);
        m_library->require_memory();
    }

    [[nodiscard]] bool factorise(const SparseMatrix<double>& lower) override {
        const CholmodTurn turn;
        m_library->factorize(lower);
        m_library->require_memory();
        return m_library->info() == Eigen::Success;
    }

    [[nodiscard]] springfit::detail::Supernodes supernodes() const override {
        if (!m_library) {
            return {};
        }
        const cholmod_factor& l = m_library->factor();
        const auto numbers = [](const void* array) { return static_cast<const int*>(array); };
        return {static_cast<int>(l.nsuper),     numbers(l.super), numbers(l.pi), numbers(l.px), numbers(l.s),
                static_cast<const double*>(l.x)};
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

} // namespace detail

/// CHOLMOD's factor, for one `SparseCholesky`.
[[nodiscard]] inline std::unique_ptr<SparseFactor> supernodal_factor() {
    return std::make_unique<detail::SupernodalFactor>();
}

/// Lets every `SparseCholesky` that the program makes from here on have CHOLMOD's factors, also those within
/// `springfit::compiled` and other units: one call at the start of `main` is for all.
inline void use_supernodal_factors() {
    set_default_sparse_factor(supernodal_factor);
}

} // namespace springfit::cholmod
