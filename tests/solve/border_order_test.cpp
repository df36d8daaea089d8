#include "sinew/solve/border_order.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace sinew::solve {
namespace {

/// Two cables through one volume, `rows` each; their abscissae take turns in z.
CoupledProblem cables(int rows) {
  CoupledProblem p;
  p.r.setZero(2 * rows);
  p.c.setZero(2 * rows);
  VolumePart& volume = p.volumes.emplace_back();
  for (int i = 0; i < 2 * rows; ++i) volume.at.push_back(i);
  for (int cable = 0; cable < 2; ++cable) {
    ChainPart& part = p.chains.emplace_back();
    for (int i = 0; i < rows; ++i) {
      part.at.push_back(2 * rows + rows * cable + i);
      part.at.push_back(2 * i + 1 - cable);
    }
  }
  return p;
}

TEST(BorderOrder, what_slides_along_a_cable_begins_with_its_rows) {
  BorderOrder order;
  order.set(cables(3));
  EXPECT_EQ(order.yielding(), 6);
  EXPECT_EQ(order.place(), (std::vector{9, 6, 10, 7, 11, 8, 0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(order.begin(), (std::vector{0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 3, 3}));
}

TEST(BorderOrder, rows_that_nothing_gives_way_to_come_last) {
  CoupledProblem p = cables(2);
  p.c.setZero(5);
  p.G.add(4, 3, 1.0);  // holds an abscissa of the first cable, the last of z to be placed before those of the second
  BorderOrder order;
  order.set(p);
  EXPECT_EQ(order.place(), (std::vector{6, 4, 7, 5, 0, 1, 2, 3, 8}));
  EXPECT_EQ(order.begin(), (std::vector{0, 0, 0, 0, 0, 0, 2, 2, 5}));
  EXPECT_TRUE(order.yields(4));
  EXPECT_FALSE(order.yields(3));
  EXPECT_FALSE(order.yields(8));
}

TEST(BorderOrder, is_found_again_where_other_places_hold_numbers) {
  BorderOrder order;
  order.set(cables(3));
  order.set(cables(1));
  EXPECT_EQ(order.place(), (std::vector{3, 2, 0, 1}));
  EXPECT_EQ(order.begin(), (std::vector{0, 0, 0, 1}));
  CoupledProblem crossed = cables(1);
  crossed.G.add(0, 0, 1.0);
  order.set(crossed);
  EXPECT_EQ(order.place(), (std::vector{2, 3, 0, 1}));
  EXPECT_EQ(order.begin(), (std::vector{0, 0, 0, 0}));
}

}  // namespace
}  // namespace sinew::solve
