#include "sinew/error/printable.hpp"

#include <gtest/gtest.h>

namespace sinew {
namespace {

struct Shown {
  std::string text, as;
  bool lines = false;
};

TEST(Printable, LeavesWhatIsShownAndNothingThatActs) {
  using namespace std::string_literals;
  const std::vector<Shown> all = {
      {"finger.vtk", "finger.vtk"},
      {"Zürich, 指, \xf0\x9f\x90\x99", "Zürich, 指, \xf0\x9f\x90\x99"},
      {"\x1b[31mred", "?[31mred"},
      {"a\0b\x7f\r\t"s, "a?b???"},
      {"one\ntwo", "one?two"},
      {"one\ntwo\r", "one\ntwo?", true},
      {"\xc2\x9b"
       "2J",
       "?2J"},  // CSI as one character of C1
      {"\x9b"
       "2J",
       "?2J"},  // the same as a lone byte
      {"\xe2\x80\xae"
       "abc",
       "?abc"},  // right-to-left override
      {"\xe2\x81\xa6"
       "abc\xe2\x81\xa9",
       "?abc?"},      // isolates
      {"\xc3", "?"},  // ends within a letter
      {"\xc3(", "?("},
      {"\xc1\xbf", "??"},  // overlong
      {"\xe0\x80\x9b", "???"},
      {"\xf0\x80\x80\x9b", "????"},
      {"\xed\xa0\x80", "???"},       // a surrogate
      {"\xf4\x90\x80\x80", "????"},  // beyond 10FFFF
      {"\xff\xfe", "??"},
      {"\xc2\xa0", "\xc2\xa0"},  // the first that is shown
      {"", ""},
  };
  for (const Shown& shown : all) EXPECT_EQ(printable(shown.text, shown.lines), shown.as);
}

}  // namespace
}  // namespace sinew
