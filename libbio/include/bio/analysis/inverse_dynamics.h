#pragma once

#include <Eigen/Dense>
#include <vector>

#include "bio/simulation/simulate.h"

namespace bio {

/// Inverse dynamics: the generalised forces that keep a system on a given motion q(t), beside the
/// forces of the system itself,
///     τ = M q̈ + Ṁ q̇ − ½ q̇ᵀ∂M q̇ + ∂V − f(q, q̇, fibres, t)     [N·m] or [N]
/// with f the muscles, the passive and the external forces. They are the reactions of a simulation
/// in which every coordinate is prescribed: Trajectory::reaction, rows = free coordinates.
///
/// The motion goes through its samples as C² cubic splines, so that q̇ and q̈ are continuous. Fibres
/// and activations follow it by the steps of every simulation (simulate.h), from static equilibrium
/// at its first posture. With samples at intervals d and steps h, q̈ is within O(d²) and the fibres
/// are within O(h²) of those along q(t). A motion at rest takes τ = ∂V − f.
///
/// @param system  compiled with these coordinates free or prescribed
/// @param times   [s] strictly rising, at least two
/// @param q       rows = the system's coordinates, columns = times [rad] or [m]
/// @param options all but startTime, duration and prescribed, which are those of the motion
/// @throws std::invalid_argument for sizes that differ, and what PrescribedMotion and simulate()
///   throw; NoStaticEquilibrium
Trajectory inverseDynamics(MusculoskeletalSystem system, const ExcitationSignal& excitation,
                           const std::vector<double>& times, const Eigen::MatrixXd& q,
                           SimulationOptions options = {});
/// Inverse dynamics of one system along several motions.
/// @param driven  with every coordinate prescribed (MusculoskeletalSystem::withAllPrescribed)
Trajectory inverseDynamicsOf(const MusculoskeletalSystem& driven,
                             const ExcitationSignal& excitation, const std::vector<double>& times,
                             const Eigen::MatrixXd& q, SimulationOptions options = {});

}  // namespace bio
