#include "sinew/io/units.hpp"

#include <gtest/gtest.h>

#include <clocale>
#include <limits>
#include <numbers>
#include <regex>

#include "sinew/error/input_error.hpp"
#include "sinew/io/nearest.hpp"

namespace sinew::io {
namespace {

using enum Dimension;

constexpr auto& every = all_dimensions;

InputFault fault_of(const std::string& text, Dimension dimension) {
  try {
    const double value = parse_quantity(text, dimension);
    ADD_FAILURE() << "'" << text << "' was read as " << value;
  } catch (const InputError& error) {
    return error.fault();
  }
  return {};
}

TEST(Units, BareNumbersAreSi) {
  for (const Dimension dimension : every) {
    EXPECT_EQ(parse_quantity("2", dimension), 2.0);
    EXPECT_EQ(parse_quantity("-1e-3", dimension), -1e-3);
    EXPECT_EQ(parse_quantity("+.5", dimension), 0.5);
    EXPECT_EQ(parse_quantity(" 5. ", dimension), 5.0);
  }
}

TEST(Units, ValuesAreTheNearestDoubles) {
  EXPECT_EQ(parse_quantity("12 mm", length), 0.012);
  EXPECT_EQ(parse_quantity("9mm", length), 0.009);  // and 9 * 0.001 is another double
  EXPECT_EQ(parse_quantity("7 cm", length), 0.07);
  EXPECT_EQ(parse_quantity("3 um", length), 3e-6);
  EXPECT_EQ(parse_quantity("1e-3 m", length), 1e-3);
  EXPECT_EQ(parse_quantity("250 kPa", pressure), 250e3);
  EXPECT_EQ(parse_quantity("1.5 MPa", pressure), 1.5e6);
  EXPECT_EQ(parse_quantity("5 GPa", pressure), 5e9);
  EXPECT_EQ(parse_quantity("3 N", force), 3.0);
  EXPECT_EQ(parse_quantity("3 kN", force), 3000.0);
  EXPECT_EQ(parse_quantity("3 mN", force), 0.003);
  EXPECT_EQ(parse_quantity("75 g", mass), 0.075);
  EXPECT_EQ(parse_quantity("7 mg", mass), 7e-6);
  EXPECT_EQ(parse_quantity("10 ms", time), 0.01);
  EXPECT_EQ(parse_quantity("2 min", time), 120.0);
  EXPECT_EQ(parse_quantity("9 us", time), 9e-6);
  EXPECT_DOUBLE_EQ(parse_quantity("30 deg", angle), std::numbers::pi / 6);
  EXPECT_EQ(parse_quantity("180 deg", angle), std::numbers::pi);
  EXPECT_EQ(parse_quantity("2 mrad", angle), 0.002);
  EXPECT_EQ(parse_quantity("9.81 m/s^2", acceleration), 9.81);
  EXPECT_EQ(parse_quantity("9810 mm/s^2", acceleration), 9.81);
  EXPECT_EQ(parse_quantity("1100 kg/m^3", density), 1100.0);
  EXPECT_EQ(parse_quantity("1.1 g/cm^3", density), 1100.0);
  EXPECT_EQ(parse_quantity("0.1 1/s", rate), 0.1);
  EXPECT_EQ(parse_quantity("20 1/m", curvature), 20.0);
  EXPECT_EQ(parse_quantity("2 1/cm", curvature), 200.0);
  EXPECT_EQ(parse_quantity("0.02 1/mm", curvature), 20.0);
  EXPECT_EQ(parse_quantity("3 Pa s", viscosity), 3.0);
  EXPECT_EQ(parse_quantity("3 kPa  s", viscosity), 3000.0);
  EXPECT_EQ(parse_quantity("3 mPa s", viscosity), 0.003);
  EXPECT_EQ(parse_quantity("12 g/m", line_density), 0.012);
  EXPECT_EQ(parse_quantity("2 kg/m", line_density), 2.0);
  EXPECT_EQ(parse_quantity("7 mN/m", line_load), 0.007);
  EXPECT_EQ(parse_quantity("7 kN/m", line_load), 7000.0);
  for (const char* two : {"2 N m", "2 Nm", "2N  m", "2\tN\tm", "2000 mN m", "2000 N mm", "2000 Nmm", "2000 mNm"}) {
    EXPECT_EQ(parse_quantity(two, torque), 2.0) << two;
  }
}

TEST(Units, WrongDimensionNamesTheExpectedOneAndItsUnits) {
  const InputFault fault = fault_of("12 kPa", length);
  EXPECT_EQ(fault.value, "12 kPa");
  EXPECT_EQ(fault.rule, "must be a length, but 'kPa' is a unit of a pressure");
  EXPECT_EQ(fault.remedy, "write a plain number in m or a number with one of the units um, mm, cm, m");
  EXPECT_EQ(fault_of("12 mm", number).remedy, "write a plain number, without a unit");
}

TEST(Units, EveryUnitIsRefusedForEveryOtherDimension) {
  for (const Dimension given : every) {
    for (const std::string_view unit : units(given)) {
      for (const Dimension wanted : every) {
        const std::string text = "2 " + std::string(unit);
        if (given == wanted) {
          EXPECT_GT(parse_quantity(text, wanted), 0.0);
        } else {
          EXPECT_NE(fault_of(text, wanted).rule.find("is a unit of " + std::string(name(given))), std::string::npos);
        }
      }
    }
  }
}

TEST(Units, UnknownUnitsSuggestTheNearest) {
  EXPECT_EQ(fault_of("5 mPa", pressure).rule, "must be a pressure, but 'mPa' is not a unit known here");
  EXPECT_EQ(fault_of("5 Mpa", pressure).remedy.substr(0, 20), "did you mean `MPa`? ");
  EXPECT_EQ(fault_of("5 furlong", length).remedy.find("did you mean"), std::string::npos);
}

TEST(Units, RefusesWhatIsNotAFiniteDecimalNumber) {
  for (const char* text :
       {"",       " ",      "nan",     "NaN",  "inf", "-inf", "+infinity", ".nan",  ".inf",      "0x10",
        "0x1p3",  "ten",    "m",       "--1",  "+-1", "1 2",  "1,5",       "1_000", "1e",        "1e999",
        "1e-999", "5 mm x", "5 mm mm", "1:30", ".",   "-",    "e5",        "5 MM",  "1e308 GPa", "\xEF\xBC\x95"}) {
    for (const Dimension dimension : every) EXPECT_FALSE(fault_of(text, dimension).remedy.empty()) << text;
  }
}

TEST(Units, TheLocaleDoesNotMatter) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8", "C"}) {
    std::setlocale(LC_ALL, locale);  // one that is not installed changes nothing
    EXPECT_EQ(parse_quantity("1.5 mm", length), 0.0015);
  }
  std::setlocale(LC_ALL, before.c_str());
}

TEST(Units, ThePatternOfTheSchemaAcceptsWhatTheReaderAccepts) {
  for (const char* text : {"5",     "-5.",       "+.5e3", "5 mm",  "5mm",    "5 mmm",  "5 1/s",     "5 m/s^2", "5 m/s2",
                           "5 N m", "5  N \t m", "5 Nm",  "5 1/m", "5 Pa s", "5 Pas",  "5 kg/m",    "5 N/m",   "nan",
                           "0x1",   "1 2",       "",      "mm",    "5 deg",  "5 kPa ", " 5 kg/m^3", "5e",      "1_0"}) {
    for (const Dimension dimension : every) {
      bool read = true;
      try {
        parse_quantity(text, dimension);
      } catch (const InputError&) {
        read = false;
      }
      EXPECT_EQ(std::regex_match(text, std::regex(quantity_pattern(dimension))), read) << text << name(dimension);
    }
  }
}

TEST(Nearest, CountsInsertDeleteReplaceAndSwap) {
  EXPECT_EQ(edit_distance("young", "young"), 0);
  EXPECT_EQ(edit_distance("yung", "young"), 1);
  EXPECT_EQ(edit_distance("youngs", "young"), 1);
  EXPECT_EQ(edit_distance("yoing", "young"), 1);
  EXPECT_EQ(edit_distance("yuong", "young"), 1);
  EXPECT_EQ(edit_distance("", "young"), 5);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(Nearest, OnlySuggestsWhatIsClose) {
  const std::vector<std::string> known = {"mesh", "mass", "density", "in"};
  EXPECT_EQ(nearest("mess", known), "mesh");
  EXPECT_EQ(nearest("dansty", known), "density");
  EXPECT_EQ(nearest("im", known), "in");
  EXPECT_EQ(nearest("mPa", {"Pa", "kPa", "MPa"}), "MPa");
  EXPECT_EQ(nearest("colour", known), "");
  EXPECT_EQ(nearest("x", known), "");
  EXPECT_EQ(nearest(std::string(100000, 'm'), known), "");
}

}  // namespace
}  // namespace sinew::io
