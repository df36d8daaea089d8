// Deferred correction of contacts. The tangent A of a linearisation has no more of them than how their normals turn on
// one solid, or on a rod that meets an obstacle (Touch::stiffness, of_rod), and how a force on a fixed point of a rod
// acts as the rod bends. Friction's part is not symmetric, and what two bodies feel of each other's motion lies outside
// of A's pattern. So with the same factors an increment dx, and the forces f of contacts, are solved for again:
//
//     A dx + J^T f + E = -r,                      E = R(x + dx, f) - R(x, f) - A_c dx,
//     u(x) + J dx + e and f obey both laws,       e = u(x + dx) - u(x) - J dx,
//
// where R is what contacts leave unbalanced, u their gaps and slips, and A_c what A has of them. All else is linear
// then, and contacts are where they will be, whatever shapes they are of. (E, e) -> dx -> (E, e) is a fixed-point
// iteration. By itself it contracts by |A^-1 dE/dx|, which is above 1 where soft bodies press hard on each other, so it
// is accelerated (solve/anderson).
#pragma once

#include "sinew/sim/contacts.hpp"
#include "sinew/solve/direct.hpp"

namespace sinew {

/// E and e of an increment. Memory of the last one is used again.
struct ContactsBeyond {
  std::vector<Eigen::Matrix3Xd> nodes;  ///< [N] E on nodes of each solid
  std::vector<Eigen::VectorXd> rods;    ///< on the strains of each rod
  Eigen::VectorXd z;                    ///< on the unknowns z
  Eigen::VectorXd u;                    ///< [m] e, of the rows of all contacts
};

void clear(const Model& model, ContactsBeyond& beyond);

/// E and e as one vector without units: E by `force` [N] and the levers of its unknowns, e by the scene's size, last.
void without_units(const Model& model, double force, const ContactsBeyond& beyond, Eigen::VectorXd& x);
/// The same back; `beyond` has the sizes.
void with_units(const Model& model, double force, const Eigen::VectorXd& x, ContactsBeyond& beyond);

/// Contacts at an iterate, or where an increment leads from it, and forces [N] there, in the world.
struct ContactsAt {
  const State& state;
  const ContactRoom& room;
  const std::vector<Vec3>& forces;
};

/// Finds E of an increment, `dx` of solids and `reduced`. Of the forces f those of the iterate are in A_c (`here`),
/// `more` have come since; `there` has them all. Solids whose tangent is not the exact one (`exact`) have nothing of
/// contacts in A.
void contacts_beyond_tangent(const Model& model, const ContactsAt& here, const std::vector<Vec3>& more,
                             const ContactsAt& there, const std::vector<char>& exact,
                             const std::vector<Eigen::Matrix3Xd>& dx, const solve::CoupledSolution& reduced,
                             ContactsBeyond& beyond);

/// e of one contact, [m]: its u where the increment leads, as the least turn of the normal brings that back to the
/// frame of the iterate (the frames themselves may jump), less u and J dx of the iterate.
Vec3 contact_beyond_rows(const Touch& here, const Touch& there, const Vec3& moved);

}  // namespace sinew
