// Couplings: what ties a rod to something else. A kind is a struct in the scene, a table here and a line in `coupling`.
#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_regions.hpp"

namespace sinew::io {
namespace {

using enum Need;

Type<Slide> slide() {
  return map<Slide>(
      {"a slide",
       {field<Slide>({"rod", required, "the rod that slides", "cable"}, &Slide::rod, name_of("rod")),
        field<Slide>({"solid", required, "the solid it slides in", "finger"}, &Slide::solid, name_of("solid")),
        field<Slide>({"points", optional, "their number from base to tip, or their ascending abscissae [m]", "15"},
                     &Slide::points, count_or_lengths(1, false)),
        field<Slide>({"channel", optional, "the points in the solid that the rod runs through, at rest [m]",
                      "[[10 mm, 0, 2 mm], [90 mm, 0, 2 mm]]"},
                     &Slide::channel, points({1, 10000})),
        field<Slide>({"anchor_tip", optional, "what holds the tip: its position, its pose, or none", "position"},
                     &Slide::anchor_tip,
                     word_of<AnchorTip>(
                         {{"none", AnchorTip::none}, {"position", AnchorTip::position}, {"pose", AnchorTip::pose}})),
        field<Slide>(
            {"friction", optional, "Coulomb's coefficient between the rod and its channel; 0 if left out", "0.1"},
            &Slide::friction, quantity(Dimension::number, at_least(0.0))),
        field<Slide>({"reach", optional, "how far outside the mesh a point may lie [m]", "2 mm"}, &Slide::reach,
                     quantity(Dimension::length, at_least(0.0)))},
       {at_most_one({"points", "channel"})}});
}

Type<Tie> tie() {
  const auto check = [](const Tie& tie, const At& at) {
    constexpr std::array<bool, 3> none = {};
    if (tie.along == none && tie.about == none) {
      at.child("along").refuse("must not be empty: the tie would hold nothing",
                               "list the axes along which it holds, or those about which it holds as `about`");
    }
    if (tie.other == tie.rod && tie.other_at == tie.at) {
      at.child("other").refuse("is the very point that is tied", "tie it to another rod, or give `at` and `other_at`");
    }
  };
  return map<Tie>(
      {"a tie",
       {field<Tie>({"rod", required, "the rod whose point is held", "cable"}, &Tie::rod, name_of("rod")),
        field<Tie>({"at", optional, "the abscissa of that point [m]; `tip`, as if left out, is its tip", "50 mm"},
                   &Tie::at, abscissa()),
        field<Tie>({"frame", optional, "the frame that holds it; the ground if there is no frame, solid, body or other",
                    "hand"},
                   &Tie::frame, name_of("frame")),
        field<Tie>({"solid", optional, "the solid that holds it", "finger"}, &Tie::solid, name_of("solid")),
        field<Tie>({"body", optional, "the rigid body that holds it", "disc"}, &Tie::body, name_of("body")),
        field<Tie>({"other", optional, "the other rod that holds it", "spine"}, &Tie::other, name_of("rod")),
        field<Tie>(
            {"other_at", optional, "the abscissa on the other rod [m]; `tip`, as if left out, is its tip", "50 mm"},
            &Tie::other_at, abscissa()),
        field<Tie>({"along", optional, "the axes of the holder along which it is held", "[x, y, z]"}, &Tie::along,
                   axes({0, 3})),
        field<Tie>({"about", optional, "the axes of the holder about which it is held", "[x, y, z]"}, &Tie::about,
                   axes({0, 3})),
        field<Tie>({"reach", optional, "how far outside the solid's mesh the point may lie [m]", "2 mm"}, &Tie::reach,
                   quantity(Dimension::length, at_least(0.0)))},
       {at_most_one({"frame", "solid", "body", "other"}), needs("other_at", "other"), needs("reach", "solid")},
       check});
}

Type<Glue> glue() {
  return map<Glue>(
      {"a glue",
       together<Glue>(
           {field<Glue>({"solid", required, "the solid that is glued", "finger"}, &Glue::solid, name_of("solid")),
            field<Glue>({"body", required, "the rigid body that carries it", "plate"}, &Glue::body, name_of("body"))},
           region_fields<Glue>(&Glue::region)),
       {exactly_one(region_names())}});
}

}  // namespace

Type<Coupling> coupling() {
  return one_of_kinds<Coupling>(
      "a coupling",
      {kind<Coupling>("slide", "a rod that slides through a solid", "{rod: cable, solid: finger, points: 15}", slide()),
       kind<Coupling>("tie", "a point of a rod that is held", "{rod: cable, at: 50 mm, frame: hand}", tie()),
       kind<Coupling>("glue", "nodes of a solid that a rigid body carries",
                      "{solid: finger, body: plate, plane: {point: [0, 0, 0], normal: [1, 0, 0]}}", glue())});
}

}  // namespace sinew::io
