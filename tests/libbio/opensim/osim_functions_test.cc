#include "libbio/opensim/osim_rules.h"

// Lengths that are functions of coordinates.
namespace bio {
namespace {

using osim_rules::OsimRules;
using osim_rules::replaced;
using osim_rules::valid;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// The flexor of `valid` with a length by function in place of its points.
std::string withFunction(const std::string& path) {
  const auto from = valid.find("<GeometryPath"), to = valid.find("</GeometryPath>");
  return valid.substr(0, from) + path + valid.substr(to + std::string("</GeometryPath>").size());
}

std::string functionPath(const std::string& length,
                         const std::string& paths = "/jointset/elbow/q") {
  return "<FunctionBasedPath name=\"path\"><coordinate_paths>" + paths +
         "</coordinate_paths><length_function>" + length + "</length_function></FunctionBasedPath>";
}

std::string polynomialText(const std::string& coefficients, int dimension, int order) {
  return "<MultivariatePolynomialFunction><coefficients>" + coefficients +
         "</coefficients><dimension>" + std::to_string(dimension) + "</dimension><order>" +
         std::to_string(order) + "</order></MultivariatePolynomialFunction>";
}

TEST_F(OsimRules, ALengthMayBeAFunctionOfCoordinates) {
  const Model model = read(withFunction(functionPath(polynomialText("0.3 -0.02 0.001", 1, 2))));
  const Path& path = model.muscles[0].path;
  EXPECT_THAT(path.points, IsEmpty());
  ASSERT_TRUE(path.function);
  EXPECT_THAT(path.function->coordinates, ElementsAre("q"));
  EXPECT_EQ(std::get<MultivariatePolynomial>(path.function->length),
            (MultivariatePolynomial{1, 2, {0.3, -0.02, 0.001}}));
  // names of coordinates as OpenSim 4.5 had them; the property as an element of its own
  const std::string old = replaced(
      replaced(functionPath("<PolynomialFunction><coefficients>0.001 -0.02 0.3</coefficients>"
                            "</PolynomialFunction>",
                            "q"),
               "<coordinate_paths>", "<coordinates>"),
      "</coordinate_paths>", "</coordinates>");
  const Model older = read(withFunction("<path>" + old + "</path>"));
  EXPECT_EQ(std::get<Function>(older.muscles[0].path.function->length),
            (Function{1, PolynomialFunction{{0.001, -0.02, 0.3}}}));
}

TEST_F(OsimRules, AFunctionIsWrittenBackToTheDigit) {
  const std::string text = withFunction(
      functionPath(polynomialText("0.14239856695841807 -0.004885711477468105 1e-300", 1, 2)));
  const Model model = read(text);
  Model changed = model;
  changed.bodies[1].mass = 2;
  rewriteOsim(folder_.file("m.osim", text), changed, folder_.path() / "changed.osim");
  EXPECT_THAT(support::contentOf(folder_.path() / "changed.osim"),
              HasSubstr("<coefficients>0.14239856695841807 -0.004885711477468105 1e-300<"));
  EXPECT_EQ(readOsim(folder_.path() / "changed.osim").muscles, model.muscles);
  writeOsim(model, folder_.path() / "fresh.osim");
  EXPECT_EQ(readOsim(folder_.path() / "fresh.osim").muscles, model.muscles);
}

TEST_F(OsimRules, FunctionsOfALength) {
  const auto complaint = [&](const std::string& length, const std::string& paths = "q") {
    return messageOf(withFunction(functionPath(length, paths)));
  };
  const std::string line = polynomialText("0.3 -0.02", 1, 1);
  EXPECT_THAT(complaint(line, "z"),
              HasSubstr("coordinate_paths = 'z', must name a coordinate of the model"));
  EXPECT_THAT(complaint(line, "q q"), HasSubstr("coordinate_paths has 'q' twice"));
  EXPECT_THAT(complaint(line, ""), HasSubstr("coordinate_paths is empty"));
  EXPECT_THAT(complaint(""), HasSubstr("length_function is missing"));
  EXPECT_THAT(complaint(polynomialText("0.3 -0.02 1", 1, 1)),
              HasSubstr("has 3 coefficients, must have 2 (dimension 1, order 1)"));
  EXPECT_THAT(complaint(polynomialText("1 1 1", 2, 1)),
              HasSubstr("dimension = 2, must be 1, the number of coordinates"));
  EXPECT_THAT(complaint(polynomialText("1", 7, 0)), HasSubstr("dimension = 7, must be 1 to 6"));
  EXPECT_THAT(complaint(polynomialText("1", 1, -1)), HasSubstr("order"));
  EXPECT_THAT(complaint(replaced(line, "<order>1", "<order>1.5")),
              HasSubstr("order = 1.5, must be a whole number"));
  EXPECT_THAT(complaint(polynomialText("1 x", 1, 1)), HasSubstr("coefficients"));
  EXPECT_THAT(complaint("<StepFunction/>"), HasSubstr("function of class StepFunction"));
  EXPECT_THAT(messageOf(withFunction("")),
              HasSubstr("GeometryPath or FunctionBasedPath is missing"));
  const Model unused = read(withFunction(
      replaced(functionPath(line), "</FunctionBasedPath>",
               "<moment_arm_functions>" + line + "</moment_arm_functions></FunctionBasedPath>")));
  EXPECT_THAT(unused.remarks, testing::Contains(HasSubstr("moment_arm_functions of its path")));
}

}  // namespace
}  // namespace bio
