#include "output/methods.h"

#include <fmt/format.h>

#include <algorithm>

#include "info/version.h"

namespace app {
namespace {

struct PublicationText {
  const char* citation;
  const char* reference;
};

PublicationText textOf(Publication publication) {
  switch (publication) {
    case Publication::alvarez2009:
      return {"Alvarez et al., 2009",
              "M. A. Alvarez, D. Luengo, N. D. Lawrence, Latent force models, AISTATS 2009."};
    case Publication::ansariMurphey2016:
      return {"Ansari and Murphey, 2016",
              "A. R. Ansari, T. D. Murphey, Sequential action control: closed-form optimal control "
              "for nonlinear and nonsmooth systems, IEEE Transactions on Robotics 32, 2016."};
    case Publication::deGroote2016:
      return {
          "De Groote et al., 2016",
          "F. De Groote, A. L. Kinney, A. V. Rao, B. J. Fregly, Evaluation of direct collocation "
          "optimal control problem formulations for solving the muscle redundancy problem, Annals "
          "of Biomedical Engineering 44, 2016."};
    case Publication::hansen2016:
      return {"Hansen, 2016",
              "N. Hansen, The CMA evolution strategy: a tutorial, arXiv:1604.00772, 2016."};
    case Publication::hauserSaccon2006:
      return {"Hauser and Saccon, 2006",
              "J. Hauser, A. Saccon, A barrier function method for the optimization of trajectory "
              "functionals with constraints, IEEE Conference on Decision and Control, 2006."};
    case Publication::hindmarsh2005:
      return {
          "Hindmarsh et al., 2005",
          "A. C. Hindmarsh, P. N. Brown, K. E. Grant, S. L. Lee, R. Serban, D. E. Shumaker, C. S. "
          "Woodward, SUNDIALS: Suite of nonlinear and differential/algebraic equation solvers, ACM "
          "Transactions on Mathematical Software 31, 2005."};
    case Publication::kassRaftery1995:
      return {"Kass and Raftery, 1995",
              "R. E. Kass, A. E. Raftery, Bayes factors, Journal of the American Statistical "
              "Association 90, 1995."};
    case Publication::ljungBox1978:
      return {"Ljung and Box, 1978",
              "G. M. Ljung, G. E. P. Box, On a measure of lack of fit in time series models, "
              "Biometrika 65, 1978."};
    case Publication::lloydBesier2003:
      return {"Lloyd and Besier, 2003",
              "D. G. Lloyd, T. F. Besier, An EMG-driven musculoskeletal model to estimate muscle "
              "forces and knee joint moments in vivo, Journal of Biomechanics 36, 2003."};
    case Publication::macKay1992:
      return {"MacKay, 1992",
              "D. J. C. MacKay, Bayesian interpolation, Neural Computation 4, 1992."};
    case Publication::millard2013:
      return {
          "Millard et al., 2013",
          "M. Millard, T. Uchida, A. Seth, S. L. Delp, Flexing computational muscle: modeling and "
          "simulation of musculotendon dynamics, Journal of Biomechanical Engineering 135, 2013."};
    case Publication::saltelli2010:
      return {"Saltelli et al., 2010",
              "A. Saltelli, P. Annoni, I. Azzini, F. Campolongo, M. Ratto, S. Tarantola, Variance "
              "based sensitivity analysis of model output. Design and estimator for the total "
              "sensitivity index, Computer Physics Communications 181, 2010."};
    case Publication::schutte1993:
      return {"Schutte et al., 1993",
              "L. M. Schutte, M. M. Rodgers, F. E. Zajac, R. M. Glaser, Improving the efficacy of "
              "electrical stimulation-induced leg cycle ergometry: an analysis based on a dynamic "
              "musculoskeletal model, IEEE Transactions on Rehabilitation Engineering 1, 1993."};
    case Publication::thelen2003:
      return {"Thelen, 2003",
              "D. G. Thelen, Adjustment of muscle mechanics model parameters to simulate dynamic "
              "contractions in older adults, Journal of Biomechanical Engineering 125, 2003."};
    case Publication::tobin1958:
      return {"Tobin, 1958",
              "J. Tobin, Estimation of relationships for limited dependent variables, Econometrica "
              "26, 1958."};
    case Publication::transtrum2012:
      return {
          "Transtrum and Sethna, 2012",
          "M. K. Transtrum, J. P. Sethna, Improvements to the Levenberg–Marquardt algorithm for "
          "nonlinear least-squares minimization, arXiv:1201.5885, 2012."};
    case Publication::wilson:
      return {"Wilson, thesis",
              "A. D. Wilson, Information-based Trajectory Optimization for Active Estimation in "
              "Mechanical Systems, PhD thesis."};
  }
  return {"", ""};
}

}  // namespace

std::string citation(Publication publication) {
  return textOf(publication).citation;
}

std::string reference(Publication publication) {
  return textOf(publication).reference;
}

void Methods::say(Part part, const std::string& sentence, const std::vector<Publication>& cited) {
  const bool isThere = std::any_of(sentences_.begin(), sentences_.end(),
                                   [&](const Sentence& other) { return other.text == sentence; });
  if (isThere) return;
  sentences_.push_back({part, sentence});
  cited_.insert(cited_.end(), cited.begin(), cited.end());
}

void Methods::assume(const std::string& sentence) {
  if (std::find(assumptions_.begin(), assumptions_.end(), sentence) == assumptions_.end())
    assumptions_.push_back(sentence);
}

std::string Methods::paragraph() const {
  std::string text = fmt::format("Computed with FisherHill {}.", info::version());
  for (const Part part : {Part::model, Part::simulation, Part::data, Part::inference}) {
    for (const Sentence& sentence : sentences_) {
      if (sentence.part == part) text += " " + sentence.text;
    }
  }
  return text;
}

std::vector<std::string> Methods::references() const {
  std::vector<Publication> sorted = cited_;  // the enumerators stand in alphabetical order
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::vector<std::string> list;
  for (const Publication publication : sorted) list.push_back(reference(publication));
  return list;
}

}  // namespace app
