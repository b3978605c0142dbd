#include "report/figure_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>

#include "output/outside_program.h"
#include "report/figure_svg.h"
#include "report/svg_text.h"
#include "report/table_text.h"

namespace app {
namespace {

namespace fs = std::filesystem;

constexpr const char* converter = "rsvg-convert";

/// "Work and precision" as work_and_precision, and each name once.
class FileNames {
 public:
  std::string of(const std::string& title, const std::string& without) {
    std::string name;
    for (const char c : title) {
      if (std::isalnum(static_cast<unsigned char>(c))) {
        name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      } else if (!name.empty() && name.back() != '_') {
        name += '_';
      }
    }
    constexpr std::size_t longest = 60;
    if (name.size() > longest) {
      const std::size_t word = name.rfind('_', longest);
      name.resize(word == name.npos || word == 0 ? longest : word);
    }
    while (name.ends_with('_')) name.pop_back();
    if (name.empty()) name = without;
    std::string unique = name;
    for (int k = 2; !used_.insert(unique).second; ++k) unique = fmt::format("{}_{}", name, k);
    return unique;
  }

 private:
  std::set<std::string> used_ = {"figures", "methods"};
};

/// @param format  "pdf" or "png"
void convert(const std::string& svg, const fs::path& file, const std::string& format) {
  const fs::path whole = fs::absolute(file), source = whole.string() + ".svg";
  std::ofstream(source, std::ios::binary) << svg;
  std::vector<std::string> words = {converter, "--format", format, "--output", whole.string()};
  if (format == "png") words.insert(words.end(), {"--width", "1280", "--keep-aspect-ratio"});
  words.push_back(source.string());
  const int status = statusOfProgram(words);
  fs::remove(source);
  if (status != 0 || !fs::exists(whole)) {
    throw std::runtime_error(fmt::format("{} could not turn a figure into {}", converter, format));
  }
}

/// The files of one report and what figures.tex says of them.
class FigureWriter {
 public:
  explicit FigureWriter(OutputFolder& folder) : folder_(folder) {}

  void add(const Section& section) { section_ = section.title; }
  void add(const Paragraph&) {}
  void add(const Figure& figure) { addDrawing(figure.title, figure.caption, figureSvg(figure)); }
  void add(const VectorDrawing& drawing) {
    addDrawing(drawing.title, drawing.caption, drawing.svg);
  }
  void add(const Playback&) {}  // paper does not move; `render` makes pictures

  void add(const Picture& picture) {
    const std::string name = names_.of(picture.title, "picture");
    write(name + ".png", picture.png);
    tellFigure(name + ".png", name, picture.title, picture.caption);
  }

  void add(const Table& table) {
    const std::string& title = table.title.empty() ? section_ : table.title;
    const std::string name = names_.of(title, "table");
    write(name + ".csv", csvText(table));
    write(name + ".tex", latexTable(table));
    // a page's worth; the rest is for longtable
    if (table.rows.size() > 40) return;
    shown_ += fmt::format(
        "\\begin{{table}}[p]\n  \\centering\n  \\caption{{{}}}\n  \\label{{tab:{}}}\n  "
        "\\input{{{}.tex}}\n\\end{{table}}\n\n",
        latexProse(title), name, name);
  }

  /// methods.tex, a section of a paper.
  void addMethods(const Methods& methods) {
    if (methods.isEmpty()) return;
    std::string text = latexProse(methods.paragraph()) + "\n";
    const auto list = [&](const char* head, const std::vector<std::string>& items) {
      if (items.empty()) return;
      text += fmt::format("\n{}\n\\begin{{itemize}}\n", head);
      for (const std::string& item : items) text += "  \\item " + latexProse(item) + "\n";
      text += "\\end{itemize}\n";
    };
    list("Assumptions:", methods.assumptions());
    list("References:", methods.references());
    write("methods.tex", text);
  }

  void writeContents(const std::string& title) {
    const std::string head = fmt::format(
        "% Figures and tables of: {}\n% The preamble needs "
        "\\usepackage{{graphicx,booktabs,array}}\n",
        oneComment(title));
    std::string list;
    for (const std::string& name : written_) list += "% file: " + name + "\n";
    write("figures.tex", head + list + "\n" + shown_);
  }

 private:
  static std::string oneComment(const std::string& text) {
    std::string line = xmlCharacters(text);
    for (char& c : line)
      if (c == '\n' || c == '\r') c = ' ';
    return line;
  }

  void write(const std::string& name, const std::string& content) {
    folder_.write(name, [&](std::ostream& out) { out << content; });
    written_.push_back(name);
  }

  void addDrawing(const std::string& title, const std::string& caption, const std::string& svg) {
    const std::string name = names_.of(title, "figure");
    write(name + ".svg", svg);
    folder_.writeFile(name + ".pdf", [&](const fs::path& path) { convert(svg, path, "pdf"); });
    written_.push_back(name + ".pdf");
    tellFigure(name + ".pdf", name, title, caption);
  }

  void tellFigure(const std::string& file, const std::string& name, const std::string& title,
                  const std::string& caption) {
    shown_ += fmt::format(
        "\\begin{{figure}}[p]\n  \\centering\n  "
        "\\includegraphics[width=\\linewidth]{{{}}}\n  \\caption{{{}.{}{}}}\n  "
        "\\label{{fig:{}}}\n\\end{{figure}}\n\n",
        file, latexProse(title), caption.empty() ? "" : " ", latexProse(caption), name);
  }

  OutputFolder& folder_;
  FileNames names_;
  std::vector<std::string> written_;
  std::string shown_;
  std::string section_;  ///< title of the one being written, for a table without a title of its own
};

}  // namespace

void requireSvgConverter(const std::string& option) {
  if (isInPath(converter)) return;
  throw std::invalid_argument(fmt::format(
      "{}: the program {} is not there (Debian package librsvg2-bin)", option, converter));
}

void writeFigureFiles(const Report& report, const Summary& summary, OutputFolder& folder) {
  FigureWriter writer(folder);
  if (report.mainPicture) writer.add(*report.mainPicture);
  if (report.mainFigure) writer.add(*report.mainFigure);
  for (const ReportPart& part : report.details) {
    std::visit([&](const auto& item) { writer.add(item); }, part);
  }
  writer.add(summaryTable(summary));
  writer.addMethods(summary.methods());
  writer.writeContents(report.title);
}

void writeFigurePngs(const Report& report, OutputFolder& folder) {
  if (!folder.active()) return;
  FileNames names;
  const auto add = [&](const Figure& figure) {
    folder.writeFile(names.of(figure.title, "figure") + ".png",
                     [&](const fs::path& path) { convert(figureSvg(figure), path, "png"); });
  };
  if (report.mainFigure) add(*report.mainFigure);
  for (const ReportPart& part : report.details) {
    if (const auto* figure = std::get_if<Figure>(&part)) add(*figure);
  }
}

}  // namespace app
