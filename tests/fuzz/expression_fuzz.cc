#include "bio/forces/expression.h"
#include "reading.h"

// A formula is compiled and evaluated, or refused.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::readsOrRefuses<std::invalid_argument>([&] {
    const bio::Expression formula(std::string(fuzz::textOf(data, size)), {"q", "qdot"});
    for (const double q : {0.0, -1.5, 1e300}) {
      const double values[] = {q, 0.5};
      [[maybe_unused]] static volatile double sink;
      sink = formula.evaluate(values);
    }
  });
  return 0;
}
