#pragma once

#include <gmock/gmock.h>

#include <exception>
#include <string>

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

/// The one line with which a reader refuses a file by an Error, without the file's folder; empty if
/// it does not.
template <class Error, class F>
std::string refusalIn(const std::string& folder, F read) {
  try {
    read();
  } catch (const Error& e) {
    const std::string what = e.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    return what.substr(folder.size() + 1);
  }
  return "";
}

}  // namespace support
