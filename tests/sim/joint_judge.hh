// SPDX-License-Identifier: GPL-2.0-or-later
// Judges every sample of a machine whose joints are not axes by the joints' limits of its configuration.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "machine/config/machine_config.hh"
#include "motion/interface/channels.hh"
#include "motion/interface/parameters.hh"
#include "tests/support/limit_checker.hh"

namespace mw::machine {

class JointJudge {
  public:
    /// Judges nothing.
    JointJudge() = default;
    explicit JointJudge(const MachineConfig &config)
        : isOn_(!config.kinematics.empty() && config.kinematics[0] != "trivkins"),
          limits_(static_cast<std::size_t>(config.num_joints)), low_(limits_.size(), -1e300),
          high_(limits_.size(), 1e300) {
        using motion::Parameter;
        for (const motion::SetParameter &p : config.parameters) {
            const auto j = static_cast<std::size_t>(p.index);
            switch (static_cast<Parameter>(p.parameter)) {
            case Parameter::JOINT_MAX_VELOCITY: limits_[j].velocity = p.value; break;
            case Parameter::JOINT_MAX_ACCELERATION: limits_[j].acceleration = p.value; break;
            case Parameter::JOINT_MIN_LIMIT: low_[j] = p.value; break;
            case Parameter::JOINT_MAX_LIMIT: high_[j] = p.value; break;
            default: break;
            }
        }
    }
    void sample(const motion::TraceSample &s, const motion::Status &status) {
        if (!isOn_) {
            return;
        }
        if (s.isEnabled == 0 || status.isHoming) {
            keep();
            return;
        }
        if (!checker_) {
            checker_ = std::make_unique<mw::testing::LimitChecker>(limits_, PERIOD_S);
        }
        checker_->sample(s.joint_pos_cmd.data());
        for (std::size_t j = 0; j < limits_.size() && status.isAllHomed; ++j) {
            const double q = s.joint_pos_cmd[j];
            constexpr double ROUNDING = 2e-6;
            if ((q < low_[j] - ROUNDING || q > high_[j] + ROUNDING) && past_.size() < 1000) {
                past_ += "joint " + std::to_string(j) + " at " + std::to_string(q) + '\n';
            }
        }
        ++count_;
    }
    /// Samples judged.
    std::size_t count() const { return count_; }
    /// Empty if no joint has exceeded its limits.
    std::string report() const { return past_ + (checker_ ? checker_->report() : std::string()); }

  private:
    static constexpr double PERIOD_S = 1e-3;
    void keep() {
        past_ = report();
        checker_.reset();
    }
    bool isOn_ = false;
    std::vector<mw::testing::AxisLimit> limits_;
    std::vector<double> low_, high_;
    std::unique_ptr<mw::testing::LimitChecker> checker_;
    std::string past_;
    std::size_t count_ = 0;
};

}  // namespace mw::machine
