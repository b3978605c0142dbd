#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "info/discovery/discover.h"
#include "output/progress_bar.h"
#include "output/summary.h"

/// Search options and search, shared by discovery in musculoskeletal models and in robots.
namespace app {

/// Options of the search.
/// @param inputScatter of --input-scatter; empty: the default
/// @throws std::invalid_argument if that is negative or no number
info::discover::Options engineOptions(int maxEffects, const std::optional<double>& inputScatter);
void addInputScatter(CLI::App& options, std::optional<double>& inputScatter,
                     const std::string& when = {}, const std::string& group = "Options");
void addTimeLimit(CLI::App& options, std::optional<double>& limit);

/// A search as its user sees it: a progress bar (unless quiet), and Ctrl-C or a time limit, which
/// end it with the result so far.
class WatchedSearch {
 public:
  /// @param limit [s] of elapsed time, from now on
  WatchedSearch(bool quiet, const std::optional<double>& limit);

  /// Lets the options call this object, which must outlive the search.
  void watch(info::discover::Options& options);
  bool wasInterrupted() const { return interrupted_; }
  bool ranOutOfTime() const { return outOfTime_; }
  /// Takes the progress bar away.
  void end() { bar_.reset(); }

 private:
  bool goesOn();

  std::optional<ProgressBar> bar_;
  std::optional<std::chrono::steady_clock::time_point> end_;
  bool interrupted_ = false, outOfTime_ = false;
};

/// Warns if there is one trial only and none is held out.
void warnOfOneTrial(Summary& summary, std::size_t training, std::size_t heldOut);

}  // namespace app
