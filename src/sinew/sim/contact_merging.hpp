// Contacts of rods that would be the same row twice are merged.
#pragma once

#include <vector>

#include "sinew/sim/curve_contact.hpp"

namespace sinew {

/// Of contacts of one pair, sorted by pair, at the start of a step, leaves one of those that a rod has at one place:
///
///   * of two pieces that follow each other and touch the same part next to where they meet, that on which the nearest
///     point lies or, if neither or both have it, that which carries a force;
///   * of a point of the rod and a piece that is nearest beside it the piece, whose normal is perpendicular to the rod,
///     unless the point is nearer by more than a hundredth of the thickness, as where the rod lies along what it
///     touches and the piece's place is that of its chord. The two rows differ only by how the rod bends in between:
///     nearly dependent, their forces would be undecided, and Newton's iteration slow.
///
/// `thin` [m] is the thickness of each pair's thinner object. A contact that stays takes over the force of one that
/// goes, if it has none.
void merge_rod_contacts(const Moment& start, const std::vector<double>& thin, std::vector<ContactState>& found);

}  // namespace sinew
