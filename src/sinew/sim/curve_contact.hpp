// Contacts of rods on their true curves: contact/simplex finds where chords are nearest, here they are brought to the
// curve.
#pragma once

#include "sinew/sim/contact_places.hpp"

namespace sinew {

/// Whether a side is the curve between two places of a rod, whose chord is `placed`.
bool is_piece_of_rod(const ContactSide& side, const contact::Simplex& placed);

/// Brings the places of a contact from the chords to the curves of rods, also where these go on beyond its pieces. A
/// place that then comes to the end of its range or of the other part is not the nearest, which another contact has: it
/// stays on its pieces, and false is returned. Where a rod lies along, the places on chords stay, which are unique.
bool refine_place(const Moment& now, const ContactState& own, const contact::Simplex& a, const contact::Simplex& b,
                  contact::Nearest& found);

/// The points of two parts where they touch, on their axes.
struct Feet {
  Vec3 a, b;
};

/// Brings a contact of a rod's piece from its chord to its true curve (`refine_place`). There the tangent of the curve
/// stands for it, a line that is carried by the cross-section: the normal is perpendicular to it (and to the other
/// line, if that is none that ends there), so that no normal force pulls along a rod; the feet are where the two lines
/// are nearest. So normals and gaps are off by second order in the section's length, where those of chords are off by l
/// kappa / 2.
Feet follow_curves(const Moment& now, const ContactState& own, const contact::Simplex& a, const contact::Simplex& b,
                   contact::Nearest& found);

/// [1/m] Second derivative of the gap between a rod's piece and an obstacle, by how the rod's cross-section turns about
/// its foot, and moves there. `found` is where they are nearest on the true curve.
rod::Mat6 curve_gap_hessian(const Moment& now, const ContactState& own, const contact::Simplex& a,
                            const contact::Simplex& b, const contact::Nearest& found);

}  // namespace sinew
