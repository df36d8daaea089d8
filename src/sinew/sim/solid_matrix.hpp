// The sparse matrix A of (10) of one volume: its pattern, once, and its values, element by element.
#pragma once

#include "sinew/sim/model.hpp"

namespace sinew {

/// Fills `matrix` and the places of a model whose body stands.
void make_pattern(SolidModel& model);

/// A of (10) / h^2: elasticity, damping, mass and springs, into a matrix of the model's pattern.
void assemble(const SolidModel& model, const solid::StepStart& start, const Eigen::Matrix3Xd& x, solid::Tangent kind,
              linalg::SparseFactor::Matrix& A);

/// Places of the tangents of faces under pressure.
std::vector<int> face_places(const SolidModel& model, const std::vector<solid::CellFace>& faces);
/// Adds the symmetric part of the tangent of a pressure. The rest acts only along the open edge of the loaded surface.
void add_pressure_tangent(const SolidModel& model, const SolidLoadModel& load, double factor, const Eigen::Matrix3Xd& x,
                          linalg::SparseFactor::Matrix& A);
/// The antisymmetric part, over the unknowns of the faces' free rim: elsewhere neighbouring faces cancel.
Eigen::MatrixXd pressure_skew(const SolidModel& model, const SolidLoadModel& load, double factor,
                              const Eigen::Matrix3Xd& x);

}  // namespace sinew
