// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/planners.hh"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "hal/core/detail/context.hh"
#include "hal/core/detail/names.hh"
#include "hal/core/instance.hh"

namespace mw::hal {

using namespace detail;

struct Planners::Runner {
    Instance &instance;
    PlannerCode code;
    int id;
    runtime::PeriodicId periodic{};
};

Planners::Planners(Instance &instance, Segment &segment, runtime::Scheduler *scheduler)
    : instance_(instance), segment_(segment), scheduler_(scheduler) {}

Planners::~Planners() = default;

void Planners::run(void *argument, std::int64_t period_ns) {
    const auto &runner = *static_cast<const Runner *>(argument);
    const UseInstance use(&runner.instance);
    context().doing = "the planner of a module";
    runner.code.function(runner.code.argument, period_ns);
    context().doing = nullptr;
}

Result<int> Planners::create(const std::string &name, std::int64_t period_ns, const PlannerCode &code) {
    Guard guard(segment_);
    if (scheduler_ == nullptr) {
        return refuse(EINVAL, "planners can only be created in the realtime process");
    }
    auto runner = std::make_unique<Runner>(instance_, code, last_id_ + 1);
    runtime::PeriodicSpec spec;
    spec.name = name;
    spec.period_ns = period_ns;
    spec.order = runtime::Order::PLANNER;
    spec.function = &run;
    spec.argument = runner.get();
    const auto periodic = scheduler_->add(spec);
    if (!periodic) {
        return std::unexpected(periodic.error());
    }
    runner->periodic = *periodic;
    runners_.push_back(std::move(runner));
    return ++last_id_;
}

bool Planners::remove(int id) {
    Guard guard(segment_);
    const auto found = std::ranges::find_if(runners_, [id](const auto &runner) { return runner->id == id; });
    if (found == runners_.end()) {
        return false;
    }
    scheduler_->remove((*found)->periodic);
    runners_.erase(found);
    return true;
}

void Planners::remove_all() {
    Guard guard(segment_);
    for (const auto &runner : runners_) {
        scheduler_->remove(runner->periodic);
    }
    runners_.clear();
}

}  // namespace mw::hal
