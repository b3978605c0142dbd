// For programs that draw, under the sanitizers: Mesa's driver and VTK keep memory until the end, in a
// library that is closed by then, so that no suppression can name it.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0";
}
