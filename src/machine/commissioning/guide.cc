// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/commissioning/guide.hh"

#include <algorithm>

#include "base/text.hh"
#include "machine/commissioning/steps.hh"

namespace mw::commissioning {

std::vector<Step> steps_of(const setup::Plan &plan) {
    std::vector<Step> steps{{"thread", "Latency of the computer", Bench::EVERY_JOINT, check_thread},
                            {"inputs", "Home switches", Bench::EVERY_JOINT, check_inputs},
                            {"estop", "Emergency stop", Bench::EVERY_JOINT, check_estop}};
    int joint = 0;
    for (const setup::Axis &axis : plan.axes) {
        for (const setup::Motor &motor : axis.motors) {
            const std::string name = to_upper(motor.name);
            steps.push_back({"direction", "Direction of " + name, joint, check_direction});
            steps.push_back({"scale", "Scale of " + name, joint, check_scale});
            steps.push_back({"home", "Home switch of " + name, joint, check_home});
            steps.push_back({"travel", "Travel of " + name, joint, check_travel});
            steps.push_back({"backlash", "Backlash of " + name, joint, measure_backlash});
            steps.push_back({"tune", "Control loop of " + name, joint, tune_servo});
            steps.push_back({"limits", "Speed and acceleration of " + name, joint, tune_limits});
            ++joint;
        }
    }
    steps.push_back({"spindle", "Spindle speed", Bench::EVERY_JOINT, check_spindle});
    steps.push_back({"probe", "Touch probe", Bench::EVERY_JOINT, check_probe});
    return steps;
}

Guide::Guide(setup::Answers answers)
    : stage_(std::move(answers)), steps_(steps_of(stage_.plan())), findings_(steps_.size()) {}

Guide::Guide(setup::Answers answers, std::vector<Finding> known, bool (*isWanted)(const Step &))
    : Guide(std::move(answers)) {
    isWanted_ = isWanted;
    for (Finding &finding : known) {
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            const std::string motor = steps_[i].joint >= 0 ? stage_.motor(steps_[i].joint).name : "";
            if (finding.fault == Fault::NONE && finding.step == steps_[i].name && finding.motor == motor) {
                findings_[i] = std::move(finding);
                break;
            }
        }
    }
    skip_known();
}

void Guide::skip_known() {
    const auto isSkipped = [this](std::size_t i) {
        return findings_[i].has_value() ? findings_[i]->fault == Fault::NONE
                                        : isWanted_ != nullptr && !isWanted_(steps_[i]);
    };
    while (current_ < steps_.size() && isSkipped(current_)) {
        ++current_;
    }
}

void Guide::begin() {
    static_cast<void>(stage_.take_changes());
    static_cast<void>(stage_.take_rejected());
    flow_.emplace(steps_[current_].run(stage_, steps_[current_].joint));
    flow_->handle().resume();
}

void Guide::cycle() {
    if (isRestartWanted()) {
        return;
    }
    if (!flow_.has_value()) {
        if (current_ == steps_.size() || isFaulted()) {
            return;
        }
        begin();
    } else {
        stage_.resume();
    }
    if (flow_->isDone()) {
        Finding finding = flow_->await_resume();
        flow_.reset();
        judge(finding);
        stage_.drop();
        finding.before = stage_.take_changes();
        for (const auto &[key, value] : finding.before) {
            finding.after[key] = stage_.answer(key);
        }
        findings_[current_] = std::move(finding);
        skip_known();
    }
}

/// In every step, a machine that went off and a rejected value are faults.
void Guide::judge(Finding &finding) {
    const int joint = steps_[current_].joint;
    const bool is_drive = joint >= 0 && stage_.bench().joint(joint).isDriveFaulted;
    const std::string rejected = stage_.take_rejected();
    if (finding.fault == Fault::STOPPED) {
        finding.fault = is_drive ? Fault::DRIVE : Fault::STOPPED;
        finding.detail = finding.detail.empty() ? stage_.why_off() : finding.detail;
    } else if (finding.fault == Fault::NONE && !rejected.empty()) {
        finding.fault = Fault::VALUE;
        finding.detail = rejected;
    }
}

bool Guide::isFaulted() const {
    return current_ < steps_.size() && findings_[current_].has_value() &&
           findings_[current_]->fault != Fault::NONE;
}

bool Guide::isReady() const {
    return std::ranges::all_of(findings_, [](const std::optional<Finding> &finding) {
        return finding.has_value() && finding->fault == Fault::NONE;
    });
}

void Guide::repeat() {
    if (isFaulted()) {
        findings_[current_].reset();
        // The step has changed values in the machine, which is restarted with the values of the files.
        stage_.want_restart();
    }
}

void Guide::undo(std::size_t step) {
    if (step >= findings_.size() || !findings_[step].has_value() || isRunning()) {
        return;
    }
    stage_.change(findings_[step]->before);
    static_cast<void>(stage_.take_changes());
    findings_[step].reset();
    current_ = std::min(current_, step);
    // Findings of later steps for this motor are not valid with the changed answers.
    for (std::size_t i = step; i < findings_.size(); ++i) {
        if (steps_[i].joint == steps_[step].joint) {
            findings_[i].reset();
        }
    }
    stage_.want_restart();
}

void Guide::stop() {
    flow_.reset();
    stage_.drop();
}

}  // namespace mw::commissioning
