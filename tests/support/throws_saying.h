#pragma once

#include <gmock/gmock.h>

#include <exception>

namespace support {

/// Expects that `function` throws, and that the message holds `words`.
template <class F>
void throwsSaying(F function, const char* words) {
  try {
    function();
    ADD_FAILURE() << "nothing thrown: " << words;
  } catch (const std::exception& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr(words));
  }
}

}  // namespace support
