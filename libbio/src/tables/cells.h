#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Lines, cells and numbers as laboratories write them, for all readers of text tables.
namespace bio::tables {

/// Without white space at its ends.
std::string_view trimmed(std::string_view text);
/// ASCII letters in lower case.
std::string lowered(std::string_view text);

inline constexpr std::string_view byteOrderMark = "\xEF\xBB\xBF";

/// @throws FileError with advice for UTF-16 and UTF-32, and for bytes that are no text
void requireTableText(std::string_view text, const std::string& file);

/// The text in UTF-8: one that is none is taken for Latin-1.
std::string inUtf8(std::string text);

/// readTextFile in UTF-8: a text that is none is taken for Latin-1. @throws FileError with advice
/// for UTF-16 and UTF-32
std::string readTableText(const std::filesystem::path& file);

/// The lines of a text with their numbers; a line ends in LF, CR LF or, in a text without any LF,
/// CR. Byte order marks at the start are skipped.
class Lines {
 public:
  explicit Lines(std::string_view text);
  bool next(std::string_view& line);
  int number() const { return number_; }

 private:
  std::string_view left_;
  char end_ = '\n';
  int number_ = 0;
};

/// Whether the text is one number with a decimal point, and its value; "+2" and infinite ones are.
bool isNumber(std::string_view digits, double& value);

enum class Separator { comma, semicolon, tab, space };

/// The cells of a line, trimmed and without their quotes, which protect separators; the separator
/// `space` stands for any run of white space.
std::vector<std::string_view> splitCells(std::string_view line, Separator separator);

/// The separator of a table whose row of names and first row of cells are these.
/// @throws std::invalid_argument with the rule if both fit two separators
Separator separatorOf(std::string_view names, std::string_view firstRow);

/// Reads the numbers of one file, which are all written with decimal points or all with decimal
/// commas.
class NumberReader {
 public:
  /// @param commas whether a comma inside a cell can be a decimal comma
  explicit NumberReader(bool commas) : commas_(commas) {}

  /// The rule that the cell breaks; empty, and its value, if it is a number. Infinite values are
  /// numbers here.
  std::string_view read(std::string_view cell, double& value);

  /// A cell whose comma may separate thousands, if no other cell decides; else empty.
  std::string_view undecided() const {
    return decimal_ == ',' && onlyThousands_ ? first_ : std::string_view{};
  }

 private:
  std::string_view readComma(std::string_view cell, double& value);
  bool commas_ = false;
  char decimal_ = 0;           ///< '.' or ',' as soon as one was seen
  bool onlyThousands_ = true;  ///< every number with a comma could have it between thousands
  std::string first_;          ///< the first of them
};

/// How a column's name states time.
struct TimeName {
  bool isTime = false;
  std::string unknownUnit;  ///< in brackets, none that is known
  double times = 1;         ///< [s] = value·times/per
  double per = 1;
};

/// `time` in any case, alone or with a unit (s, ms, us, min) in brackets or behind `_`, `,`, `/` or
/// a space: "Time [ms]", "TIME_ms", "time (s)", "Time,s"; and Delsys's "X[s]".
TimeName timeNameOf(std::string_view column);

}  // namespace bio::tables
