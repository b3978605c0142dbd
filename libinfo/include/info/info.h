#pragma once

/// What most programs need of libinfo, in the order of docs/tutorial.md.
#include "info/discovery/discover.h"      // the search for the effect that a model lacks
#include "info/dynamics/integrate.h"      // Rk4, ImplicitMidpoint: steps of ẋ = f(x, u, θ)
#include "info/dynamics/predictor.h"      // makePredictor: outputs of an experiment over θ
#include "info/dynamics/sensitivity.h"    // simulate, simulateWithSensitivity
#include "info/dynamics/variational.h"    // VariationalIntegrator: steps of a Lagrangian
#include "info/estimation/estimate.h"     // estimate: parameters from measurements
#include "info/estimation/monte_carlo.h"  // monteCarlo: the experiment simulated many times
#include "info/estimation/profile_likelihood.h"  // intervals where the model is strongly curved
#include "info/information/fisher.h"             // fisherInformation, cramerRaoBound
#include "info/information/identifiability.h"    // identifiability: in words, what cannot be seen
