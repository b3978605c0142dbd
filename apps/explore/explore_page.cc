#include "explore/explore_page.h"

#include <fmt/format.h>
#include <openssl/sha.h>

#include "explore_assets.h"
#include "info/version.h"
#include "output/json_text.h"
#include "output/text.h"
#include "report_assets.h"

namespace app {
namespace {

/// For Content-Security-Policy: 'sha256-…' of a script.
std::string hashSource(const std::string& script) {
  std::string hash(SHA256_DIGEST_LENGTH, '\0');
  SHA256(reinterpret_cast<const unsigned char*>(script.data()), script.size(),
         reinterpret_cast<unsigned char*>(hash.data()));
  return fmt::format("'sha256-{}'", base64(hash));
}

std::string about(const Summary& summary) {
  std::string text;
  if (!summary.warnings().empty()) {
    text += "<h2>Warnings</h2>\n<ul>\n";
    for (const std::string& warning : summary.warnings())
      text += fmt::format("<li>{}</li>\n", htmlText(warning));
    text += "</ul>\n";
  }
  text += fmt::format("<h2>Provenance</h2>\n<p>Made by</p>\n<pre>{}</pre>\n",
                      htmlText(summary.commandLine()));
  for (const auto& input : summary.inputs())
    text += fmt::format("<p>{} SHA-256 {}</p>\n", htmlText(input.path), input.sha256);
  text += fmt::format(
      "<p>FisherHill {}. The page simulates by itself, without a network. 3-D view by three.js "
      "0.170.0, curves by uPlot 1.6.32 (both MIT licence).</p>\n",
      htmlText(info::version()));
  return text;
}

}  // namespace

std::string explorePage(const std::string& title, const std::string& verdict,
                        const nlohmann::ordered_json& data, const Summary& summary) {
  const std::string libraries = fmt::format("{}\n{}", assets::threeJs, assets::uplotJs);
  const std::string scripts = fmt::format("{}\n{}\n{}\n{}\n{}", assets::sceneJs, assets::playerJs,
                                          assets::curvesJs, assets::parametersJs, assets::pageJs);
  const std::string policy = fmt::format(
      "default-src 'none'; script-src {} {} {} 'wasm-unsafe-eval' blob:; worker-src blob:; "
      "style-src 'unsafe-inline'; img-src data: blob:",
      hashSource(std::string(assets::engineJs)), hashSource(libraries), hashSource(scripts));
  return filled(assets::pageHtml,
                {{"policy", policy},
                 {"title", htmlText(title)},
                 {"licences", fmt::format("{}\n{}", assets::threeLicence, assets::uplotLicence)},
                 {"styles", fmt::format("{}\n{}", assets::uplotCss, assets::pageCss)},
                 {"verdict", htmlText(verdict)},
                 {"about", about(summary)},
                 {"data", scriptText(data)},
                 {"core", std::string(assets::liveCore)},
                 {"worker", fmt::format("{}\n{}", assets::coreJs, assets::workerJs)},
                 {"engine", std::string(assets::engineJs)},
                 {"libraries", libraries},
                 {"scripts", scripts}});
}

}  // namespace app
