#include "bio/simulation/simulate_batch.h"

#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "simulation/simd/hinge_model.h"
#include "simulation/simd/lane_driver.h"

namespace bio {
namespace {

using lanes::HingeModel;
using lanes::Lanes;
using lanes::Single;
template <class Of>
using MakeSolver = lanes::LaneSolver<Of>* (*)(const lanes::LaneModel<Of>&);

/// One job, and what is shared by several.
struct Member {
  const LaneJob* job;
  const HingeModel<Single>* system;
  lanes::ActivationCourse* course;
  Trajectory* result;
  bool succeeded = false;
};

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
      : job_(&job), course_(*job.system, *job.excitation, *job.start, options) {}

  bool fits(const LaneJob& other) const {
    if (job_->excitation != other.excitation ||
        job_->system->numMuscles() != other.system->numMuscles() ||
        job_->start->activation != other.start->activation) {
      return false;
    }
    for (std::size_t i = 0; i < job_->system->numMuscles(); ++i) {
      if (!haveSameActivation(job_->system->muscles()[i], other.system->muscles()[i])) return false;
    }
    return true;
  }
  lanes::ActivationCourse& course() { return course_; }

 private:
  const LaneJob* job_;
  lanes::ActivationCourse course_;
};

/// Jobs of one structure, to their ends: a lane whose job has ended takes the next one.
template <class Of>
class LaneGroup {
 public:
  LaneGroup(std::span<Member> members, const SimulationOptions& options)
      : members_(members),
        options_(&options),
        arms_(lanes::lanesFor<Of>(*members_.front().system)) {
    // lanes without a job hold the first one's numbers
    for (int l = 0; l < Of::width; ++l) setLane(arms_, l, *members_.front().system);
    muscles_.resize(arms_.muscles.size());
    step_.muscles = muscles_.data();
    step_.newtonTolerance = options.newtonTolerance;
    step_.maxIterations = options.maxIterations;
    step_.symmetric = isSymmetric(options.integrator);
  }

  void run(MakeSolver<Of> makeSolver) {
    for (Lane& lane : lanes_) begin(lane);
    std::unique_ptr<lanes::LaneSolver<Of>> solver;
    while (isWanted()) {
      if (armsChanged_) solver.reset(makeSolver(arms_.view()));
      armsChanged_ = false;
      solver->solve(step_);
      for (Lane& lane : lanes_) {
        const int l = indexOf(lane);
        if (step_.done[l] == 0) continue;
        lane.driver->take(l, step_);
        if (ask(lane)) continue;
        end(lane);
        begin(lane);
      }
    }
  }

 private:
  struct Lane {
    Member* member = nullptr;
    std::optional<lanes::LaneDriver> driver;
  };

  int indexOf(const Lane& lane) const { return static_cast<int>(&lane - lanes_.data()); }

  /// The next job, if there is one.
  void begin(Lane& lane) {
    if (next_ == members_.size()) {
      step_.wanted[indexOf(lane)] = 0;
      rest(indexOf(lane));
      return;
    }
    lane.member = &members_[next_++];
    const Member& m = *lane.member;
    setLane(arms_, indexOf(lane), *m.system);
    armsChanged_ = true;
    lane.driver.emplace(*m.job->system, *m.job->excitation, *m.job->start, *options_, *m.course,
                        m.system->mass);
    ask(lane);
  }

  void end(Lane& lane) {
    Member& member = *lane.member;
    member.succeeded = lane.driver->succeeded();
    if (!member.succeeded) return;
    *member.result = lane.driver->finish();
    stepping::completeStates(*member.job->system, *member.job->excitation, *member.result);
  }

  /// The lane's next step; false if its job has none.
  bool ask(Lane& lane) {
    const int l = indexOf(lane);
    const bool more = lane.driver->ask(l, step_);
    step_.wanted[l] = more ? -1 : 0;
    step_.iterations[l] = 0;
    step_.previous[l] = 0;
    step_.place[l] = std::numeric_limits<double>::quiet_NaN();
    return more;
  }

  bool isWanted() const {
    bool wanted = false;
    for (int l = 0; l < Of::width; ++l) wanted = wanted || step_.wanted[l] != 0;
    return wanted;
  }

  /// A lane without a job repeats the begin of its last step, or of the first lane's, since NaN or
  /// infinity would slow the batch; its result is ignored.
  void rest(int lane) {
    const int from = lanes_[static_cast<std::size_t>(lane)].member ? lane : 0;
    step_.length[lane] = step_.length[from];
    step_.qEnd[lane] = step_.q[lane] = step_.q[from];
    step_.p[lane] = step_.p[from];
    for (lanes::MuscleStep<Of>& m : muscles_) {
      m.fibreLengthEnd[lane] = m.fibreLength[lane] = m.fibreLength[from];
      m.activation[lane] = m.activation[from];
    }
  }

  std::span<Member> members_;
  const SimulationOptions* options_;
  std::size_t next_ = 0;
  HingeModel<Of> arms_;
  bool armsChanged_ = true;
  std::array<Lane, Of::width> lanes_;
  std::vector<lanes::MuscleStep<Of>> muscles_;
  lanes::LaneStep<Of> step_{};
};

void advance(std::span<Member> members, const SimulationOptions& options,
             LaneInstructions instructions) {
#ifdef FISHERHILL_WIDE_LANES
  using enum LaneInstructions;
  // up to four jobs fill no more than half of eight lanes
  if ((instructions == avx512 || (instructions == best && members.size() > 4)) &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    return LaneGroup<Lanes<8>>(members, options).run(lanes::avx512Solver);
  }
  if ((instructions == avx2 || instructions == best) && __builtin_cpu_supports("avx2")) {
    return LaneGroup<Lanes<4>>(members, options).run(lanes::avx2Solver);
  }
#else
  static_cast<void>(instructions);
#endif
  LaneGroup<Lanes<4>>(members, options).run(lanes::plainSolver);
}

}  // namespace

std::vector<Trajectory> simulateTogether(std::span<const LaneJob> jobs,
                                         const SimulationOptions& options,
                                         LaneInstructions instructions) {
  // lanes step together, so that none has parts of its own
  const bool known = isVariational(options.integrator) &&
                     options.integrator != Integrator::variationalAdaptive && !options.progress;
  std::vector<Trajectory> results(jobs.size());
  std::vector<std::optional<HingeModel<Single>>> arms(jobs.size());
  std::vector<bool> waiting(jobs.size(), true);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    stepping::checkSimulation(*jobs[i].system, *jobs[i].excitation, *jobs[i].start, options);
    if (known && !stepping::changesForces(*jobs[i].system, options))
      arms[i] = lanes::hingeModel(*jobs[i].system);
  }
  std::vector<std::unique_ptr<SharedCourse>> courses;
  for (std::size_t first = 0; first < jobs.size(); ++first) {
    if (!waiting[first] || !arms[first]) continue;
    std::vector<Member> members;
    std::vector<std::size_t> places;
    for (std::size_t i = first; i < jobs.size(); ++i) {
      if (!waiting[i] || !arms[i] || !lanes::sameStructure(*arms[first], *arms[i])) continue;
      if (courses.empty() || !courses.back()->fits(jobs[i])) {
        courses.push_back(std::make_unique<SharedCourse>(jobs[i], options));
      }
      members.push_back({&jobs[i], &*arms[i], &courses.back()->course(), &results[i]});
      places.push_back(i);
    }
    advance(members, options, instructions);
    for (std::size_t m = 0; m < places.size(); ++m) {
      waiting[places[m]] = false;
      if (!members[m].succeeded) arms[places[m]].reset();
    }
  }
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (arms[i]) continue;
    results[i] = simulate(*jobs[i].system, *jobs[i].excitation, *jobs[i].start, options);
  }
  return results;
}

}  // namespace bio
