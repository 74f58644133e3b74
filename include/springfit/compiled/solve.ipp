// SPDX-License-Identifier: BSD-3-Clause
// Matrices, factors and solvers.

namespace springfit {

SPRINGFIT_INSTANTIATION class SymmetricMatrix<double>;
SPRINGFIT_INSTANTIATION class detail::SimplicialFactor<double>;
SPRINGFIT_INSTANTIATION std::unique_ptr<SparseFactor> simplicial_factor<double>();
SPRINGFIT_INSTANTIATION class BasicSparseCholesky<double>;
SPRINGFIT_INSTANTIATION void SparseCholesky::substitute<1>(Rows<1>&) const;
SPRINGFIT_INSTANTIATION void SparseCholesky::substitute<4>(Rows<4>&) const;
SPRINGFIT_INSTANTIATION void SparseCholesky::substitute<8>(Rows<8>&) const;
SPRINGFIT_INSTANTIATION void SparseCholesky::substitute<12>(Rows<12>&) const;
SPRINGFIT_INSTANTIATION void SparseCholesky::substitute<16>(Rows<16>&) const;
SPRINGFIT_INSTANTIATION class BasicBlockCholesky<SparseCholesky>;
SPRINGFIT_INSTANTIATION class SymmetricSolver<double>;
SPRINGFIT_INSTANTIATION class BlockMatrix<2, double>;
SPRINGFIT_INSTANTIATION class BlockMatrix<3, double>;
SPRINGFIT_INSTANTIATION class detail::NodeCholesky<2, double>;
SPRINGFIT_INSTANTIATION class detail::NodeCholesky<3, double>;
SPRINGFIT_INSTANTIATION class CorotatedPreconditioner<2, double>;
SPRINGFIT_INSTANTIATION class CorotatedPreconditioner<3, double>;
SPRINGFIT_INSTANTIATION class CorotatedSolver<2, double>;
SPRINGFIT_INSTANTIATION class CorotatedSolver<3, double>;
SPRINGFIT_INSTANTIATION class fem::Stiffness<2, double>;
SPRINGFIT_INSTANTIATION class fem::Stiffness<3, double>;

} // namespace springfit
