#include "bio/simulation/simulate_batch.h"

#include <memory>
#include <optional>

#include "simulation/simd/hinge_model.h"
#include "simulation/simd/lane_driver.h"

namespace bio {
namespace {

using lanes::HingeModel;
using lanes::Lanes;
using lanes::Single;
using MakeSolver = lanes::LaneSolver* (*)(const lanes::LaneModel<Lanes>&);

MakeSolver solverFor(LaneInstructions instructions) {
#ifdef FISHERHILL_WIDE_LANES
  if (instructions == LaneInstructions::best && __builtin_cpu_supports("avx2")) {
    return lanes::wideSolver;
  }
#endif
  static_cast<void>(instructions);
  return lanes::plainSolver;
}

// Whether two laws have the same numbers.
bool haveSameNumbers(const SchutteActivation<double>& a, const SchutteActivation<double>& b) {
  return a.timeScale == b.timeScale && a.activation1 == b.activation1 &&
         a.activation2 == b.activation2;
}
bool haveSameNumbers(const muscles::FirstOrderActivation<double>& a,
                     const muscles::FirstOrderActivation<double>& b) {
  return a.activationTime == b.activationTime && a.deactivationTime == b.deactivationTime &&
         a.minimum == b.minimum;
}
bool haveSameNumbers(const muscles::SmoothActivation<double>& a,
                     const muscles::SmoothActivation<double>& b) {
  return a.activationTime == b.activationTime && a.deactivationTime == b.deactivationTime &&
         a.smoothing == b.smoothing;
}
bool haveSameNumbers(const muscles::DirectActivation& a, const muscles::DirectActivation& b) {
  return a.least == b.least && a.most == b.most;
}

muscles::AnyActivation activationOf(const muscles::AnyMuscle& muscle) {
  return std::visit([](const auto& m) { return m.parameters().activation(); }, muscle);
}

/// Whether activations of two muscles follow one excitation alike.
bool haveSameActivation(const SystemMuscle& a, const SystemMuscle& b) {
  if (a.activation.schutte() || b.activation.schutte()) {
    return a.activation.schutte() && b.activation.schutte() &&
           haveSameNumbers(*a.activation.schutte(), *b.activation.schutte());
  }
  const muscles::AnyActivation other = activationOf(*b.muscle.ifOther());
  return std::visit(
      [&]<class Law>(const Law& law) {
        const Law* same = std::get_if<Law>(&other);
        return same && haveSameNumbers(law, *same);
      },
      activationOf(*a.muscle.ifOther()));
}

/// Activations of one job, good for all others that have the same laws, excitations and start.
class SharedCourse {
 public:
  SharedCourse(const LaneJob& job, const SimulationOptions& options)
      : job_(&job), course_(*job.arm, *job.excitation, *job.start, options) {}

  bool fits(const LaneJob& other) const {
    if (job_->excitation != other.excitation ||
        job_->arm->numMuscles() != other.arm->numMuscles() ||
        job_->start->activation != other.start->activation) {
      return false;
    }
    for (std::size_t i = 0; i < job_->arm->numMuscles(); ++i) {
      if (!haveSameActivation(job_->arm->muscles()[i], other.arm->muscles()[i])) return false;
    }
    return true;
  }
  lanes::ActivationCourse& course() { return course_; }

 private:
  const LaneJob* job_;
  lanes::ActivationCourse course_;
};

/// Some jobs of one structure, at most as many as there are lanes, to their ends.
class LaneGroup {
 public:
  struct Member {
    const LaneJob* job;
    const HingeModel<Single>* arm;
    lanes::ActivationCourse* course;
    Trajectory* result;
  };

  LaneGroup(const std::vector<Member>& members, const SimulationOptions& options)
      : members_(members), arms_(lanes::lanesFor(*members.front().arm)) {
    for (int l = 0; l < lanes::width; ++l) {
      // lanes without a job hold the first one's numbers
      setLane(arms_, l, *members[hasJob(l) ? static_cast<std::size_t>(l) : 0].arm);
    }
    for (const Member& m : members) {
      drivers_.push_back(std::make_unique<lanes::LaneDriver>(
          *m.job->arm, *m.job->excitation, *m.job->start, options, *m.course, m.arm->mass));
    }
    muscles_.resize(arms_.muscles.size());
    step_.muscles = muscles_.data();
    step_.newtonTolerance = options.newtonTolerance;
    step_.maxIterations = options.maxIterations;
    step_.symmetric = options.integrator == Integrator::variational;
  }

  void run(MakeSolver makeSolver) {
    const std::unique_ptr<lanes::LaneSolver> solver(makeSolver(arms_.view()));
    for (int l = 0; l < lanes::width; ++l) ask(l);
    while (isWanted()) {
      solver->solve(step_);
      for (int l = 0; l < lanes::width; ++l) {
        if (step_.done[l] == 0) continue;
        drivers_[static_cast<std::size_t>(l)]->take(l, step_);
        ask(l);
      }
    }
    for (std::size_t l = 0; l < drivers_.size(); ++l) {
      if (!drivers_[l]->succeeded()) continue;
      const Member& member = members_[l];
      *member.result = drivers_[l]->finish();
      stepping::completeStates(*member.job->arm, *member.job->excitation, *member.result);
    }
  }

  bool succeeded(std::size_t member) const { return drivers_[member]->succeeded(); }

 private:
  void ask(int lane) {
    const bool more = hasJob(lane) && drivers_[static_cast<std::size_t>(lane)]->ask(lane, step_);
    step_.wanted[lane] = more ? -1 : 0;
    step_.iterations[lane] = 0;
    step_.previous[lane] = 0;
    if (!more) rest(lane);
  }

  bool isWanted() const {
    bool wanted = false;
    for (int l = 0; l < lanes::width; ++l) wanted = wanted || step_.wanted[l] != 0;
    return wanted;
  }

  bool hasJob(int lane) const { return static_cast<std::size_t>(lane) < members_.size(); }

  /// A lane without a step repeats the numbers of a valid lane, since NaN or infinity would slow
  /// the batch; its result is ignored.
  void rest(int lane) {
    const int from = hasJob(lane) ? lane : 0;
    step_.length[lane] = step_.length[from];
    step_.qEnd[lane] = step_.q[lane] = step_.q[from];
    step_.p[lane] = step_.p[from];
    for (lanes::MuscleStep& m : muscles_) {
      m.fibreLengthEnd[lane] = m.fibreLength[lane] = m.fibreLength[from];
      m.activation[lane] = m.activation[from];
    }
  }

  std::vector<Member> members_;
  HingeModel<Lanes> arms_;
  std::vector<std::unique_ptr<lanes::LaneDriver>> drivers_;
  std::vector<lanes::MuscleStep> muscles_;
  lanes::LaneStep step_{};
};

}  // namespace

std::vector<Trajectory> simulateTogether(std::span<const LaneJob> jobs,
                                         const SimulationOptions& options,
                                         LaneInstructions instructions) {
  const bool known = (options.integrator == Integrator::variational ||
                      options.integrator == Integrator::variationalLeft) &&
                     !options.progress;
  std::vector<Trajectory> results(jobs.size());
  std::vector<std::optional<HingeModel<Single>>> arms(jobs.size());
  std::vector<bool> waiting(jobs.size(), true);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    stepping::checkSimulation(*jobs[i].arm, *jobs[i].excitation, *jobs[i].start, options);
    if (known && !stepping::changesForces(*jobs[i].arm, options))
      arms[i] = lanes::hingeModel(*jobs[i].arm);
  }
  const MakeSolver makeSolver = solverFor(instructions);
  std::vector<std::unique_ptr<SharedCourse>> courses;
  for (std::size_t first = 0; first < jobs.size(); ++first) {
    if (!waiting[first] || !arms[first]) continue;
    std::vector<LaneGroup::Member> members;
    std::vector<std::size_t> places;
    for (std::size_t i = first; i < jobs.size() && members.size() < lanes::width; ++i) {
      if (!waiting[i] || !arms[i] || !lanes::sameStructure(*arms[first], *arms[i])) continue;
      if (courses.empty() || !courses.back()->fits(jobs[i])) {
        courses.push_back(std::make_unique<SharedCourse>(jobs[i], options));
      }
      members.push_back({&jobs[i], &*arms[i], &courses.back()->course(), &results[i]});
      places.push_back(i);
    }
    LaneGroup group(members, options);
    group.run(makeSolver);
    for (std::size_t m = 0; m < places.size(); ++m) {
      waiting[places[m]] = false;
      if (!group.succeeded(m)) arms[places[m]].reset();
    }
  }
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (arms[i]) continue;
    results[i] = simulate(*jobs[i].arm, *jobs[i].excitation, *jobs[i].start, options);
  }
  return results;
}

}  // namespace bio
