#include "output/methods.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "output/summary.h"

namespace app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Methods, TellEachSentenceOnceInTheOrderOfTheParts) {
  Methods methods;
  EXPECT_TRUE(methods.isEmpty());
  methods.say(Methods::Part::inference, "Third.", {Publication::macKay1992});
  methods.say(Methods::Part::model, "First.", {Publication::wilson, Publication::macKay1992});
  methods.say(Methods::Part::simulation, "Second.");
  methods.say(Methods::Part::model, "First.");
  EXPECT_THAT(methods.paragraph(), StartsWith("Computed with FisherHill "));
  EXPECT_THAT(methods.paragraph(), testing::EndsWith(". First. Second. Third."));
  EXPECT_THAT(methods.references(),
              ElementsAre(HasSubstr("MacKay, Bayesian interpolation"), HasSubstr("Wilson")));
  methods.assume("One.");
  methods.assume("One.");
  EXPECT_THAT(methods.assumptions(), ElementsAre("One."));
}

TEST(Methods, SayWhichIntegratorRan) {
  for (const auto& [integrator, words] : std::vector<std::pair<std::string, std::string>>{
           {"vi",
            "midpoint variational integrator (Wilson, thesis), the forces shared by both ends"},
           {"vi-left", "the forces at the beginning of a step"},
           {"vi-adaptive",
            "with steps of 0.002 s and shorter ones where their estimated errors ask"},
           {"rk4", "classical Runge–Kutta method of fourth order with a fixed step of 0.002 s"},
           {"cvode", "CVODE (Hindmarsh et al., 2005)"}}) {
    Summary summary{CommandContext{}};
    summary.setSimulation(integrator, 0.002, 1, 0);
    EXPECT_THAT(summary.methods().paragraph(), HasSubstr(words));
    EXPECT_EQ(summary.methods().references().size(), integrator == "rk4" ? 0u : 1u);
  }
}

TEST(Methods, CiteEveryPublicationByItsYear) {
  for (int i = 0; i <= static_cast<int>(Publication::wilson); ++i) {
    const auto publication = static_cast<Publication>(i);
    const std::string cited = citation(publication);
    EXPECT_THAT(reference(publication), HasSubstr(cited.substr(cited.rfind(' ') + 1)));
  }
}

}  // namespace
}  // namespace app
