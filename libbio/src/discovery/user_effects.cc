#include <algorithm>
#include <cmath>
#include <set>

#include "bio/discovery/user_effect.h"
#include "bio/forces/expression.h"
#include "tables/toml_table.h"

namespace bio::discover {
namespace {

using info::discover::Quantity;

bool isSymbol(const std::string& text) {
  const auto isSmall = [](char c) { return c >= 'a' && c <= 'z'; };
  return !text.empty() && text.size() <= 40 && isSmall(text.front()) &&
         std::all_of(text.begin(), text.end(),
                     [&](char c) { return isSmall(c) || (c >= '0' && c <= '9') || c == '_'; });
}

std::string symbolOf(TomlTable& table, const char* key) {
  const std::string text = table.required(key, table.text(key));
  if (!isSymbol(text)) table.fail(key, "must be small letters, digits and '_', a letter first");
  return text;
}

/// Reads the [[effect.parameter]] tables of one effect.
class ParameterReader {
 public:
  explicit ParameterReader(UserEffect& effect) : effect_(effect) {}

  void read(TomlTable& table) {
    const std::string symbol = symbolOf(table, "name");
    if (symbol == "q" || symbol == "qdot" ||
        std::count(effect_.constants.begin(), effect_.constants.end(), symbol))
      table.fail("name", "has a meaning already");
    const bool isAmplitude = effect_.constants.empty();
    Quantity quantity;
    quantity.name = effect_.id + "." + symbol;
    quantity.unit = table.text("unit").value_or("");
    const auto nominal = table.number("nominal");
    if (isAmplitude && nominal && *nominal != 0)
      table.fail("nominal",
                 "must be 0 or left out: the first parameter is the amplitude, without which there "
                 "is no force");
    quantity.nominal = isAmplitude ? 0 : table.required("nominal", nominal);
    quantity.lower = table.required("lower", table.number("lower"));
    quantity.upper = table.required("upper", table.number("upper"));
    const bool encloses = quantity.lower <= quantity.nominal &&
                          quantity.nominal <= quantity.upper && quantity.lower < quantity.upper;
    if (!encloses || !std::isfinite(quantity.upper - quantity.lower))
      table.fail("lower",
                 "must be finite, at most the nominal value and less than upper, which must be at "
                 "least that");
    quantity.sd = table.required(
        "sd",
        table.number(
            "sd", [](double sd) { return sd > 0 && std::isfinite(sd); }, "must be finite and > 0"));
    auto starts = table.numbers("starts");
    if (starts && !isAmplitude) table.fail("starts", "is for the first parameter, the amplitude");
    for (const double start : starts.value_or(std::vector<double>()))
      if (!(start != 0 && start >= quantity.lower && start <= quantity.upper))
        table.fail("starts", "must lie within the bounds and not be 0");
    table.finish();
    if (isAmplitude) starts_ = starts ? *starts : usualStarts(quantity);
    effect_.constants.push_back(symbol);
    effect_.quantities.push_back(quantity);
  }

  /// @pre every parameter has been read
  void setStarts() {
    for (const double start : starts_) {
      std::vector<double>& all = effect_.starts.emplace_back(1, start);
      for (std::size_t i = 1; i < effect_.quantities.size(); ++i)
        all.push_back(effect_.quantities[i].nominal);
    }
  }

 private:
  static std::vector<double> usualStarts(const Quantity& amplitude) {
    std::vector<double> starts;
    for (const double start : {0.3 * amplitude.sd, -0.3 * amplitude.sd})
      if (start > amplitude.lower && start < amplitude.upper) starts.push_back(start);
    return starts;
  }

  UserEffect& effect_;
  std::vector<double> starts_;
};

/// Whether there is no force without the amplitude, at a few positions and speeds.
bool vanishesWithoutAmplitude(const Expression& force, const UserEffect& effect) {
  std::vector<double> values(2 + effect.quantities.size());
  for (std::size_t i = 0; i < effect.quantities.size(); ++i)
    values[2 + i] = effect.quantities[i].nominal;
  for (const double q : {-1.3, -0.2, 0.1, 0.7, 2.1})
    for (const double speed : {-5.3, -0.4, 0.3, 1.1, 6.7}) {
      values[0] = q;
      values[1] = speed;
      const double without = force.evaluate(values.data());
      if (std::isfinite(without) && without != 0) return false;
    }
  return true;
}

void checkExpression(const UserEffect& effect, const TomlTable& table) {
  std::vector<std::string> variables = {"q", "qdot"};
  variables.insert(variables.end(), effect.constants.begin(), effect.constants.end());
  try {
    if (!vanishesWithoutAmplitude(Expression(effect.expression, variables), effect))
      table.fail("expression",
                 "must vanish where " + effect.constants.front() + ", the first parameter, is 0");
  } catch (const std::invalid_argument& error) {
    table.fail("expression", error.what());
  }
}

UserEffect readEffect(TomlTable& table, const std::string& file) {
  UserEffect effect;
  effect.file = file;
  effect.id = symbolOf(table, "id");
  effect.name = table.text("name").value_or(effect.id);
  effect.sentence = table.text("sentence").value_or("");
  effect.coordinate = table.text("coordinate").value_or("");
  effect.expression = table.required("expression", table.text("expression"));
  std::vector<TomlTable> parameters = table.tables("parameter");
  table.finish();
  if (parameters.empty()) table.fail("id", "needs a [[effect.parameter]], the amplitude");
  ParameterReader reader(effect);
  for (TomlTable& one : parameters) reader.read(one);
  reader.setStarts();
  checkExpression(effect, table);
  if (effect.sentence.empty()) effect.sentence = "A force of " + effect.expression + ".";
  return effect;
}

void readFile(const std::string& file, std::vector<UserEffect>& effects) {
  TomlTable table = TomlTable::read(file);
  std::vector<TomlTable> tables = table.tables("effect");
  table.finish();
  (void)table.required("effect", tables.empty() ? std::optional<int>() : std::optional<int>(1));
  std::set<std::string> ids;
  for (TomlTable& each : tables) {
    effects.push_back(readEffect(each, file));
    if (!ids.insert(effects.back().id).second) each.fail("id", "is given twice");
  }
}

}  // namespace

std::vector<UserEffect> readUserEffects(const std::vector<std::string>& files) {
  std::vector<UserEffect> effects;
  for (const std::string& file : files) readFile(file, effects);
  return effects;
}

}  // namespace bio::discover
