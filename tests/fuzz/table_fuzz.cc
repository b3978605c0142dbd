#include <array>
#include <cmath>
#include <memory>

#include "bio/opensim/osim_file.h"
#include "bio/review/trial_review.h"
#include "bio/tables/table_file.h"
#include "bio/tables/trial.h"
#include "reading.h"

namespace {

bool same(const bio::Table& a, const bio::Table& b) {
  if (a.columns != b.columns || a.values.rows() != b.values.rows()) return false;
  for (Eigen::Index i = 0; i < a.values.size(); ++i) {
    const double x = a.values.data()[i], y = b.values.data()[i];
    if (!(x == y || (std::isnan(x) && std::isnan(y)))) return false;
  }
  return true;
}

}  // namespace

// The first byte says what the file is called; the rest is a table, and perhaps a trial of the
// eight-muscle elbow. A table that was read and can be written reads back the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::array<fuzz::InputFile, 3> files = {fuzz::InputFile("a.sto"), fuzz::InputFile("a.csv"),
                                                 fuzz::InputFile("a.txt")};
  static fuzz::InputFile again("again.sto");
  static const bio::Model model = bio::readOsim(FISHERHILL_SOURCE_DIR "/models/elbow8.osim");
  if (size < 1) return 0;
  const auto& path = files[data[0] % files.size()].holding(fuzz::textOf(data + 1, size - 1));

  const auto kind = data[0] & 0x80 ? bio::TableKind::any : bio::TableKind::timeSeries;
  bio::Table table;
  if (!fuzz::readsOrRefuses<bio::FileError>([&] { table = bio::readTable(path, kind); })) return 0;
  if (kind == bio::TableKind::any) return 0;
  if (fuzz::readsOrRefuses<bio::FileError>([&] { bio::writeTable(table, again.path()); })) {
    if (!same(bio::readTable(again.path()), table)) fuzz::finding("table", "reads back otherwise");
  }
  const bool extra = data[0] & 0x40;
  fuzz::readsOrRefuses<bio::FileError>([&] {
    reviewTrial(bio::readTrial(path, model, {.ignoreExtra = extra, .baseline = 0.01}), model);
  });
  return 0;
}
