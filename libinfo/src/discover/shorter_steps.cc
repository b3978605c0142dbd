#include "info/discover/shorter_steps.h"

#include <stdexcept>

namespace info::discover {

SteppedVerdict runAtShorterSteps(const std::function<Attempt(double step)>& attempt, double step,
                                 double shortest) {
  Draft draft;
  while (true) {
    Attempt one = attempt(step);
    try {
      Verdict verdict = run(one.data, one.options, &draft);
      if (verdict.finding != Finding::numerical || step < shortest)
        return {std::move(verdict), std::move(one.options), step};
    } catch (const std::domain_error&) {
      if (step < shortest) throw;
    }
    step /= 2;
  }
}

}  // namespace info::discover
