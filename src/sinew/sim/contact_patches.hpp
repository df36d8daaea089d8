// Of many points of a rigid body on one plane of another, those that carry are the corners around them.
#pragma once

#include <vector>

#include "sinew/sim/contact_places.hpp"

namespace sinew {

/// Patches of so many contacts are left as they are: the corners of boxes and hulls are fewer.
inline constexpr int kWholePatch = 16;

/// Of contacts, sorted by pair, in which more than `kWholePatch` points of one rigid object face one plane of another,
/// leaves out those that are above or among the corners of the face on which the first would come to lie. What the
/// corners can do, all can:
///
/// Points x_i in the plane of the common normal n press with f_i in Coulomb's cone K around n. A point inside is
/// x = sum c_i x_i with c_i >= 0, sum c_i = 1 over the corners; for a force f in K there, the forces c_i f at the
/// corners lie in K and have the same sum and, as sum x_i x (c_i f) = x x f, the same moment. And as both are rigid,
/// the gap above a plane is an affine function g of the place, for the points of the face and all motions; what is
/// above the face has gap(x) >= g(x) = sum c_i g(x_i). So none overlaps if the corners do not.
void reduce_patches(const Moment& start, std::vector<ContactState>& found);

}  // namespace sinew
