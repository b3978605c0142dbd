#include "report/interval_drawing.h"

#include <gtest/gtest.h>

#include <regex>

namespace app {
namespace {

struct Name {
  double x;               // where it ends
  std::string fit, text;  // how it is narrowed; itself
};
std::vector<Name> namesIn(const std::string& svg) {
  static const std::regex row(
      "<text x=\"([0-9.]+)\" y=\"[0-9.]+\" text-anchor=\"end\"([^>]*)>([^<]*)");
  std::vector<Name> names;
  for (std::sregex_iterator it(svg.begin(), svg.end(), row), end; it != end; ++it)
    names.push_back({std::stod((*it)[1]), (*it)[2], (*it)[3]});
  return names;
}
IntervalRow row(const std::string& name) {
  return {.name = name, .estimate = 1, .interval = std::pair(0.0, 1.0)};
}

// At 7.4 a character, which is DejaVu Sans of 15.
TEST(IntervalDrawing, MakesRoomForLongNames) {
  const std::string longest = "crosstalk_ANC_BIC + Fmax_TRIlong + bias (input)";
  const auto names = namesIn(intervalDrawing({row("visc"), row(longest)}, "x"));
  ASSERT_EQ(names.size(), 2U);
  EXPECT_EQ(names[0].x, names[1].x);
  EXPECT_EQ(names[1].text, longest);
  EXPECT_GT(names[1].x, 7.4 * static_cast<double>(longest.size()));
  EXPECT_EQ(names[1].fit, "");
}

TEST(IntervalDrawing, NarrowsWhatIsLongerThanHalfThePicture) {
  const auto names = namesIn(intervalDrawing({row(std::string(200, 'n')), row("µ·µ")}, "x"));
  ASSERT_EQ(names.size(), 2U);
  EXPECT_LT(names[0].x, 700);
  EXPECT_NE(names[0].fit.find("textLength"), std::string::npos);
  EXPECT_EQ(names[1].fit, "");
}

TEST(IntervalDrawing, KeepsTheScaleWhereItIsForShortNames) {
  const auto names = namesIn(intervalDrawing({row("visc")}, "x"));
  ASSERT_EQ(names.size(), 1U);
  EXPECT_EQ(names[0].x, 286);
}

}  // namespace
}  // namespace app
