#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bio/tables/study_file.h"
#include "command/command.h"

namespace app {

/// Whether an estimated number belongs to one trial: its start, "trial2.initial.NAME" or
/// "initial.NAME", or a knot of a latent excitation.
bool isOfATrial(const std::string& parameter);

/// Columns of study.csv.
const std::vector<std::string>& studyColumns();

/// Makes the subcommands of the program.
using CommandList = std::function<std::vector<std::unique_ptr<Command>>()>;

/// Carries one subject through emg, calibrate with its held-out test, and discover, whose results
/// go into folders of these names in `folder`; what is there is made anew. A command that fails is
/// the subject's status and message.
/// @param commands emg, calibrate and discover among them
/// @return cells of the subject's row, separated by commas
/// @throws Interrupted after Ctrl-C
std::string studySubject(const bio::StudyFile& study, const bio::StudySubject& subject,
                         const std::filesystem::path& folder, const CommandContext& context,
                         const CommandList& commands);

}  // namespace app
