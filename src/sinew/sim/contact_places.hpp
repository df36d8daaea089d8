// Where the parts of bodies, obstacles, solids and rods are at one time: at the start of a step or at an iterate.
#pragma once

#include <string>
#include <vector>

#include "sinew/contact/meeting.hpp"
#include "sinew/sim/step_context.hpp"

namespace sinew {

/// A time at which parts are placed; it refers to what it was made from.
struct Moment {
  const Model& model;
  const State& state;
  const std::vector<Placement>& frames;         ///< how far each has moved
  const std::vector<rod::Configuration>& rods;  ///< of those that touch something

  /// Of a body or an obstacle.
  contact::Pose pose(const Collider& own) const;
  contact::Simplex placed(const ContactSide& side) const;
};

/// Where a rod is at the abscissae by which it touches, 3 x n [m].
void touching_points(const Moment& now, int rod, Eigen::Matrix3Xd& points);

/// [m] of the point of a rod's part that these weights of its ends tell.
inline double abscissa_of(const ContactSide& side, const std::array<double, 3>& weights) {
  return side.local.corners() == 1 ? side.abscissae[0]
                                   : weights[0] * side.abscissae[0] + weights[1] * side.abscissae[1];
}

/// Bodies and obstacles.
bool is_rigid(const Collider& own);

/// Whether it may touch anything.
bool in_a_pair(const Model& model, const Collider& own);

/// Of what is rigid.
const contact::Shape& shape_of(const Model& model, const Collider& own);

/// The parts by which it presses into surfaces.
const std::vector<contact::Simplex>& prongs_of(const Model& model, const Collider& own);

/// The surface of a solid, or of a rigid mesh; null of all else.
const contact::Mesh* mesh_of(const Model& model, const Collider& own);

/// Rods that may touch something, in a state and on these bases; others are left as they are.
void configure_touching(const Model& model, const std::vector<Placement>& bases, const State& state,
                        std::vector<rod::Configuration>& rods);
/// How far each frame has moved by a time.
std::vector<Placement> frames_at(const Model& model, double time);

/// Whether an object is a rigid shape: it has no surface of triangles and does not bend.
bool is_shape(const Model& model, const Collider& own);
/// Whether both of two are: contact/meeting is for these.
bool are_shapes(const Model& model, const PairModel& pair);

/// How far a point, in the axes of a rigid shape that is no mesh, with what is within `radius` of it is outside that
/// [m]; negative inside.
double gap_to_shape(const contact::Shape& shape, const Vec3& local, double radius);

/// By how much the edges of the prism that stands for a cylinder are outside it [m]; 0 of all else.
double stands_out(const Model& model, const Collider& object);

/// [m] the smallest extent of an object at rest; infinite of half-spaces.
double thickness_of(const Model& model, const Collider& own);

/// The name it has in the scene.
const std::string& name_of(const Model& model, const Collider& own);

/// "a and b", as a message names a pair of the model's.
std::string name_of_pair(const Model& model, int pair);

}  // namespace sinew
