#pragma once

// libc++ 14 has std::from_chars for integers only; for doubles, the same rules by strtod of musl,
// which rounds correctly as well. Included before every file of the page's core.

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <string>

namespace std {

inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const char* digits = first;
  if (digits != last && *digits == '-') ++digits;
  if (digits == last) return {first, errc::invalid_argument};
  const char c = *digits;
  const bool isWord = c == 'i' || c == 'I' || c == 'n' || c == 'N';
  if (!isWord && c != '.' && (c < '0' || c > '9')) return {first, errc::invalid_argument};
  if (c == '0' && digits + 1 != last && (digits[1] == 'x' || digits[1] == 'X')) {
    value = 0;  // hexadecimal only where it is asked for
    return {digits + 1, errc()};
  }
  const string text(first, last);
  char* end = nullptr;
  errno = 0;
  const double read = strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  const char* stop = first + (end - text.c_str());
  if (errno == ERANGE) return {stop, errc::result_out_of_range};
  value = read;
  return {stop, errc()};
}

}  // namespace std
