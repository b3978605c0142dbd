#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <regex>
#include <set>
#include <sstream>

#include "command/command_line.h"
#include "command/command_tree.h"
#include "command/completion.h"
#include "command/described_commands.h"
#include "command/manual_page.h"
#include "program/all_commands.h"
#include "robot_options/robot_program.h"
#include "support/scratch_folder.h"

// Man page and completions against what the parser itself prints as help.
namespace app {
namespace {

/// Names of options at the beginning of a line of --help, which CLI11 writes.
std::set<std::string> optionsInHelp(const CLI::App& app) {
  const std::string help = app.help();
  const std::regex line("(^|\n) +(-[^ ]+)");
  std::set<std::string> names;
  for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) {
    for (const std::string& name : CLI::detail::split((*at)[2], ',')) names.insert(name);
  }
  return names;
}

std::vector<const CLI::App*> subcommandsOf(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// The part of a text from `begin` up to the next `end`; empty if there is none.
std::string partOf(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  if (from == text.npos) return "";
  return text.substr(from, text.find(end, from + begin.size()) - from);
}

std::string inRoff(const std::string& text) {
  return std::regex_replace(text, std::regex("-"), "\\-");
}

struct Pages : testing::Test {
  CommandLine line{allCommandsWith(robotCommand(), discoverInRobot)};
  DescribedCommand program = describe(line.program());
  support::ScratchFolder scratch;

  /// What bash offers after these words, the last of which is being typed.
  std::set<std::string> offered(const std::vector<std::string>& typed) {
    std::ofstream(scratch / "completion") << bashCompletion(program);
    std::string command =
        "cd '" + scratch.path().string() + "' && bash -c 'source completion; COMP_WORDS=(";
    for (const std::string& word : typed) command += "\"" + word + "\" ";
    command += "); COMP_CWORD=" + std::to_string(typed.size() - 1) +
               "; _fisherhill; printf \"%s\\n\" \"${COMPREPLY[@]}\"'";
    std::set<std::string> words;
    FILE* pipe = popen(command.c_str(), "r");
    char text[4096];
    while (std::fgets(text, sizeof text, pipe)) words.insert(CLI::detail::trim_copy(text));
    EXPECT_EQ(pclose(pipe), 0) << command;
    words.erase("");
    return words;
  }
};

TEST_F(Pages, ManPageHasEverySubcommandAndEveryOptionOfIt) {
  const std::string page = manualPage(program, "1.2.3");
  const std::string shared = partOf(page, ".SH COMMON OPTIONS", ".SH ");
  ASSERT_GT(subcommandsOf(line.program()).size(), 9u);
  for (const CLI::App* command : subcommandsOf(line.program())) {
    const std::string name = inRoff(command->get_name());
    const std::string section = partOf(page, ".SS " + name + "\n", ".S");
    ASSERT_NE(section, "") << name;
    EXPECT_THAT(page, testing::HasSubstr("\\fBfisherhill " + name + "\\fR"));
    for (const std::string& option : optionsInHelp(*command)) {
      const std::string entry = "\\fB" + inRoff(option) + "\\fR";
      EXPECT_THAT(section + shared, testing::HasSubstr(entry)) << name;
    }
  }
  for (const std::string& option : optionsInHelp(line.program())) {
    EXPECT_THAT(partOf(page, ".SH OPTIONS", ".SH "), testing::HasSubstr(inRoff(option)));
  }
}

// Options of one group may stand apart from each other on the command line.
TEST_F(Pages, ManPageHasEachGroupOfOptionsOnceUnderItsHeading) {
  const std::string page = manualPage(program, "1.2.3");
  const std::string shared = partOf(page, ".SH COMMON OPTIONS", ".SH ");
  std::size_t headings = 0;
  for (const DescribedCommand& command : program.subcommands) {
    const std::string section = partOf(page, ".SS " + inRoff(command.name) + "\n", ".S");
    for (const DescribedOption& option : command.options) {
      const std::string entry = ".TP\n\\fB" + inRoff(option.names.front()) + "\\fR";
      const std::size_t at = section.find(entry);
      if (at == section.npos) {
        EXPECT_THAT(shared, testing::HasSubstr(entry)) << command.name;
        continue;
      }
      const std::size_t heading = section.rfind(".PP\n\\fI", at);
      const bool isUnderAHeading = heading != section.npos;
      EXPECT_EQ(isUnderAHeading, option.group != "Options") << command.name << entry;
      if (!isUnderAHeading) continue;
      const std::string its = ".PP\n\\fI" + inRoff(option.group) + "\\fR\n";
      EXPECT_EQ(section.substr(heading, its.size()), its) << command.name << entry;
      EXPECT_EQ(section.find(its), section.rfind(its)) << command.name << entry;
      ++headings;
    }
  }
  EXPECT_GT(headings, 20u);
}

TEST_F(Pages, ProgramsOfTheirOwnHaveAPageWithEveryOptionOfTheirSubcommand) {
  const std::string page =
      helperPage(program, "1.2.3", "fisherhill-mpi", "ensemble", "It works.", "mpirun -n N");
  EXPECT_TRUE(page.starts_with(".TH FISHERHILL\\-MPI 1 "));
  EXPECT_THAT(page, testing::HasSubstr("\nfisherhill\\-mpi \\- simulate"));
  EXPECT_THAT(page, testing::HasSubstr("\\fBmpirun \\-n N\\fR \\fBfisherhill\\-mpi ensemble\\fR"));
  int options = 0;
  for (const CLI::App* command : subcommandsOf(line.program())) {
    if (command->get_name() != "ensemble") continue;
    for (const std::string& option : optionsInHelp(*command)) {
      EXPECT_THAT(page, testing::HasSubstr("\\fB" + inRoff(option) + "\\fR")) << option;
      ++options;
    }
  }
  EXPECT_GT(options, 15);
  EXPECT_THROW(helperPage(program, "1.2.3", "x", "nothing", "", ""), std::invalid_argument);
}

TEST_F(Pages, ManPageTellsValuesAsTheyAreTyped) {
  const std::string page = manualPage(program, "1.2.3");
  for (const char* entry :
       {"\\fB\\-\\-prior\\fR \\fINAME=MEAN:SD\\fR\n", "\\fB\\-\\-out\\fR \\fIDIR\\fR\n",
        "\\fB\\-\\-starts\\fR \\fIN\\fR\n", "\\fB\\-\\-loss\\fR \\fBgaussian|huber|student\\fR\n",
        "may be repeated; default: the measured", "fisherhill check\\fR \\fIFILE\\fR... ["}) {
    EXPECT_THAT(page, testing::HasSubstr(entry));
  }
}

TEST_F(Pages, BashOffersExactlyTheOptionsOfTheSubcommand) {
  std::set<std::string> names = optionsInHelp(line.program());
  for (const CLI::App* command : subcommandsOf(line.program())) names.insert(command->get_name());
  EXPECT_EQ(offered({"fisherhill", ""}), names);
  for (const CLI::App* command : subcommandsOf(line.program())) {
    EXPECT_EQ(offered({"fisherhill", command->get_name(), "-"}), optionsInHelp(*command))
        << command->get_name();
  }
}

TEST_F(Pages, BashOffersTheWordsFilesAndFoldersThatAValueMayBe) {
  using testing::ElementsAre;
  std::ofstream(scratch / "arm one.osim") << "x";
  std::filesystem::create_directory(scratch / "results");
  EXPECT_THAT(offered({"fisherhill", "replay", "--integrator", ""}),
              ElementsAre("cvode", "rk4", "vi", "vi-adaptive", "vi-left"));
  EXPECT_THAT(offered({"fisherhill", "replay", "--integrator", "=", "vi-"}),
              ElementsAre("vi-adaptive", "vi-left"));
  EXPECT_THAT(offered({"fisherhill", "robot", "su"}), ElementsAre("suspended-mass"));
  EXPECT_THAT(offered({"fisherhill", "check", "arm"}), ElementsAre("arm one.osim"));
  EXPECT_THAT(offered({"fisherhill", "check", "--out", ""}), ElementsAre("results"));
  EXPECT_THAT(offered({"fisherhill", "check", "--seed", ""}), ElementsAre());
}

TEST_F(Pages, ZshHasEverySubcommandAndEveryOptionOfIt) {
  const std::string text = zshCompletion(program);
  for (const CLI::App* command : subcommandsOf(line.program())) {
    const std::string name = command->get_name();
    EXPECT_THAT(text, testing::HasSubstr("'" + name + ":"));
    const std::string part = partOf(text, "    " + name + ")\n", ";;");
    for (const std::string& option : optionsInHelp(*command)) {
      EXPECT_TRUE(std::regex_search(part, std::regex("'\\*?" + option + "=?\\[")))
          << name << option;
    }
  }
}

TEST(ManualPage, KeepsWhatRoffWouldTakeForARequest) {
  DescribedCommand program{"fisherhill", "Does.", "", {}, {}, {}};
  program.options.push_back({{"--deep"},
                             "N",
                             ".hidden \\n 'quoted'\n.TP",
                             "Options",
                             "-1",
                             DescribedOption::Value::anything,
                             {},
                             false,
                             false});
  const std::string page = manualPage(program, "1.2.3");
  EXPECT_THAT(page, testing::HasSubstr("\\&.hidden \\en 'quoted'\n\\&.TP; default \\-1\n"));
}

TEST_F(Pages, TreeHasEverySubcommandWithEveryOptionAndItsExample) {
  const nlohmann::ordered_json tree = commandTree(program);
  EXPECT_EQ(tree.at("subcommands").size(), subcommandsOf(line.program()).size());
  for (const CLI::App* command : subcommandsOf(line.program())) {
    const auto& all = tree.at("subcommands");
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) {
      return one.at("name") == command->get_name();
    });
    ASSERT_NE(found, all.end()) << command->get_name();
    std::set<std::string> named;
    for (const auto& option : found->at("options"))
      for (const auto& name : option.at("names")) named.insert(name.get<std::string>());
    EXPECT_EQ(named, optionsInHelp(*command)) << command->get_name();
    EXPECT_THAT(found->at("example").get<std::string>(), testing::HasSubstr("fisherhill "));
  }
}

}  // namespace
}  // namespace app
