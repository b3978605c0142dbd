#include <cstdio>

#include "info/version.h"

int main() {
  std::printf("fisherhill %s\n", info::version());
  return 0;
}
