#include "sinew/solve/direct.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace sinew::solve {

namespace {

/// Symmetric scaling: every row's and column's largest entry near one (Ruiz, four sweeps).
Eigen::VectorXd equilibrate(Eigen::MatrixXd& K) {
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(K.rows());
  for (int sweep = 0; sweep < 4; ++sweep) {
    Eigen::VectorXd d = K.cwiseAbs().rowwise().maxCoeff();
    for (double& value : d) value = value > 0.0 ? 1.0 / std::sqrt(value) : 1.0;
    K = d.asDiagonal() * K * d.asDiagonal();
    scale.array() *= d.array();
  }
  return scale;
}

}  // namespace

CoupledSolution solve_direct(const CoupledProblem& problem) {
  const Eigen::Index nz = problem.B.rows(), nl = problem.W.rows(), n = nz + nl;
  CoupledSolution solution;
  if (n == 0) {
    solution.ok = true;
    return solution;
  }
  Eigen::MatrixXd K(n, n);
  K << problem.B, problem.G.transpose(), problem.G, -problem.W;
  Eigen::VectorXd b(n);
  b << -problem.r, problem.c;
  const Eigen::VectorXd scale = equilibrate(K);
  b.array() *= scale.array();
  if (!K.allFinite() || !b.allFinite()) return solution;

  constexpr double kTolerance = 1e-9;
  const auto relative = [&](const Eigen::VectorXd& y) {
    const double size = b.lpNorm<Eigen::Infinity>() + y.lpNorm<Eigen::Infinity>();
    return size > 0.0 ? (b - K * y).lpNorm<Eigen::Infinity>() / size : 0.0;
  };
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(K);
  Eigen::VectorXd y = lu.solve(b);
  if (y.allFinite()) y += lu.solve(b - K * y);
  solution.residual = y.allFinite() ? relative(y) : INFINITY;
  const Eigen::VectorXd pivots = lu.matrixLU().diagonal().cwiseAbs();
  const bool singular = !(pivots.minCoeff() > 1e-14 * pivots.maxCoeff()) || !(lu.rcond() > 1e-15);
  if (singular || !(solution.residual < kTolerance)) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> cod;
    cod.setThreshold(1e-12);
    cod.compute(K);
    y = cod.solve(b);
    solution.redundant = true;
    solution.residual = y.allFinite() ? relative(y) : INFINITY;
  }
  solution.ok = solution.residual < (solution.redundant ? 1e-6 : kTolerance);
  y.array() *= scale.array();
  solution.dz = y.head(nz);
  solution.dlambda = y.tail(nl);
  return solution;
}

}  // namespace sinew::solve
