// The matrix A of (10) of one volume: its pattern and how it is factored, once, and its values, element by element.
#pragma once

#include <span>

#include "sinew/sim/model.hpp"
#include "sinew/sim/step.hpp"

namespace sinew {

/// Makes the plan of every solid's factor, and finds all places in it; for models whose bodies, rows and loads stand.
void plan_factors(Model& model);

/// Adds A of (10) / h^2: elasticity, damping, mass and springs, at the places of the model.
void assemble(const SolidModel& model, const solid::StepStart& start, const Eigen::Matrix3Xd& x,
              const solid::Deformation& deformation, solid::Tangent kind, double* values);
/// The same where nothing else needs the deformation.
void assemble(const SolidModel& model, const solid::StepStart& start, const Eigen::Matrix3Xd& x, solid::Tangent kind,
              double* values);

/// Adds the stiffness of a grip.
void add_grip(const SolidModel& model, const Grip& grip, double* values);

/// Adds a symmetric matrix over nodes that share a cell, three coordinates each.
void add_over_nodes(const SolidModel& model, std::span<const int> nodes, const Eigen::Ref<const Eigen::MatrixXd>& K,
                    double* values);

/// Adds the symmetric part of the tangent of a pressure. The rest acts only along the open edge of the loaded surface.
void add_pressure_tangent(const SolidLoadModel& load, double factor, const Eigen::Matrix3Xd& x, double* values);
/// The antisymmetric part, over the unknowns of the faces' free rim: elsewhere neighbouring faces cancel.
Eigen::MatrixXd pressure_skew(const SolidModel& model, const SolidLoadModel& load, double factor,
                              const Eigen::Matrix3Xd& x);

}  // namespace sinew
