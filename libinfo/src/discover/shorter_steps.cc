#include "info/discover/shorter_steps.h"

namespace info::discover {

SteppedVerdict runAtShorterSteps(const std::function<Attempt(double step)>& attempt, double step,
                                 double shortest) {
  Draft draft;
  while (true) {
    Attempt one = attempt(step);
    Verdict verdict = run(one.data, one.options, &draft);
    if (verdict.finding != Finding::numerical || step < shortest)
      return {std::move(verdict), std::move(one.options), step};
    step /= 2;
  }
}

}  // namespace info::discover
