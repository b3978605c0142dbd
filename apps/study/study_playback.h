#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "bio/tables/study_file.h"
#include "report/report.h"

namespace app {

/// One trial of each calibrated subject in three dimensions, a held-out one if there is one: what
/// the subject's calibrated model makes of it. Subjects without a result are left out.
/// @param folderOf  a subject's results
std::optional<Playback> studyPlayback(
    const bio::StudyFile& study,
    const std::function<std::filesystem::path(const bio::StudySubject&)>& folderOf);

}  // namespace app
