#pragma once

#include <string>
#include <vector>

namespace app {

enum class Publication {
  alvarez2009,
  ansariMurphey2016,
  deGroote2016,
  hansen2016,
  hauserSaccon2006,
  hindmarsh2005,
  kassRaftery1995,
  ljungBox1978,
  lloydBesier2003,
  macKay1992,
  millard2013,
  saltelli2010,
  schutte1993,
  thelen2003,
  tobin1958,
  transtrum2012,
  wilson
};

/// "Thelen, 2003", as it stands in a sentence.
std::string citation(Publication publication);
/// Authors, title, journal and year.
std::string reference(Publication publication);

/// What a report says of how its numbers were made, in sentences that may be quoted. Each part of
/// the program adds those of what it has done, so that nothing is said of what was not used.
class Methods {
 public:
  /// In the order in which they are told.
  enum class Part { model, simulation, data, inference };

  /// A sentence with its full stop; one that is there already is not repeated. The publications are
  /// named in it and listed below.
  void say(Part part, const std::string& sentence, const std::vector<Publication>& cited = {});

  /// What the numbers presuppose; likewise.
  void assume(const std::string& sentence);

  bool isEmpty() const { return sentences_.empty(); }
  /// All sentences, in the order of the parts.
  std::string paragraph() const;
  const std::vector<std::string>& assumptions() const { return assumptions_; }
  /// In alphabetical order.
  std::vector<std::string> references() const;

 private:
  struct Sentence {
    Part part;
    std::string text;
  };
  std::vector<Sentence> sentences_;
  std::vector<std::string> assumptions_;
  std::vector<Publication> cited_;
};

}  // namespace app
