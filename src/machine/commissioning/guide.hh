// SPDX-License-Identifier: GPL-2.0-or-later
// Guides an operator through the steps of commissioning. A screen, a terminal or a script shows its prompts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "machine/commissioning/stage.hh"

namespace mw::commissioning {

struct Step {
    std::string name;   ///< "direction"
    std::string title;  ///< "Direction of X"
    int joint = Bench::EVERY_JOINT;
    Flow<Finding> (*run)(Stage &stage, int joint) = nullptr;
};

/// The steps for a machine, in their order.
std::vector<Step> steps_of(const setup::Plan &plan);

/// All calls come from one thread. The machine's side calls attach() with each machine that it has started,
/// then cycle() in each task cycle until isRestartWanted() or isOver().
class Guide {
  public:
    explicit Guide(setup::Answers answers);
    /// Begins with the findings of earlier sessions. `isWanted` selects the steps of this session; other
    /// steps are skipped.
    Guide(setup::Answers answers, std::vector<Finding> known, bool (*isWanted)(const Step &));
    ~Guide() { stop(); }
    Guide(const Guide &) = delete;
    Guide &operator=(const Guide &) = delete;

    void attach(Bench *bench) { stage_.attach(bench); }
    void cycle();
    /// True if the machine must be written and started again with answers().
    bool isRestartWanted() const { return stage_.isRestartWanted(); }

    const setup::Answers &answers() const { return stage_.answers(); }
    const Prompt &prompt() const { return stage_.prompt(); }
    int prompt_number() const { return stage_.prompt_number(); }
    bool act(int prompt_number, const Act &act) { return stage_.act(prompt_number, act); }

    const std::vector<Step> &steps() const { return steps_; }
    /// The current step, or the next one.
    std::size_t current() const { return current_; }
    /// The newest finding of each step; nothing: the step has not been done, or must be repeated.
    const std::vector<std::optional<Finding>> &findings() const { return findings_; }
    bool isRunning() const { return flow_.has_value(); }
    /// True if all selected steps are done, or a step has a fault. Then call repeat() or stop().
    bool isOver() const { return !isRunning() && (isFaulted() || current_ == steps_.size()); }
    bool isFaulted() const;
    /// True if all steps are done without a fault.
    bool isReady() const;

    /// Repeats the current step after a restart of the machine.
    void repeat();
    /// Undoes the changes of a step, which must then be repeated. The machine must be restarted.
    void undo(std::size_t step);
    /// Stops the motion, switches the machine off and ends the current step.
    void stop();

  private:
    void begin();
    void judge(Finding &finding);
    void skip_known();

    bool (*isWanted_)(const Step &) = nullptr;

    Stage stage_;
    std::vector<Step> steps_;
    std::vector<std::optional<Finding>> findings_;
    std::size_t current_ = 0;
    std::optional<Flow<Finding>> flow_;
};

}  // namespace mw::commissioning
