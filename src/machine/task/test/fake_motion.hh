// SPDX-License-Identifier: GPL-2.0-or-later
// A model of the realtime side for task, without planner and joints.
#pragma once

#include <string>
#include <vector>

#include "motion/interface/channels.hh"
#include "motion/interface/parameters.hh"

namespace mw::task::test {

/// A motion controller that completes each move in one cycle and records its commands.
class FakeMotion {
  public:
    explicit FakeMotion(motion::Channels &channels) : channels_(channels) {
        status.isAllHomed = true;
        status.num_spindles = 1;
        status.num_joints = 3;
        status.isInPosition = true;
        publish();
    }

    void step() {
        motion::Command command;
        while (channels_.immediate.pop(command)) {
            take(command);
        }
        if (!isHolding) {
            take_path();
        }
        ++status.cycle;
        publish();
    }

    motion::Status status;
    std::vector<std::string> log;
    bool isHolding = false;
    bool rejecting_moves = false;
    bool mode_stuck = false;
    motion::Reason teleop_refusal = motion::Reason::NONE;  ///< answer to each change to axis jogs
    motion::Reason jog_refusal = motion::Reason::NONE;     ///< answer to each continuous jog
    motion::Reason setting_refusal = motion::Reason::NONE;
    motion::JogContinuous last_jog;
    motion::CommandBody last;  ///< last immediate command
    motion::RigidTap last_tap;
    double corner_scale = -1;  ///< corner scale of the last move
    double tolerance = -1;     ///< tolerance of the last move

  private:
    void take(const motion::Command &command) {
        motion::Answer answer{command.id};
        last = command.body;
        if (const auto *abort = std::get_if<motion::Abort>(&command.body)) {
            status.epoch = abort->new_epoch;
            log.emplace_back("abort");
        } else if (std::holds_alternative<motion::Enable>(command.body)) {
            status.isEnabled = true;
        } else if (std::holds_alternative<motion::Disable>(command.body)) {
            status.isEnabled = false;
        } else if (const auto *mode = std::get_if<motion::SetMode>(&command.body)) {
            if (!status.isInPosition && mode->mode != status.mode) {
                answer.kind = motion::AnswerKind::REFUSED;
                answer.reason = motion::Reason::MOVING;
            } else if (mode->mode == motion::Mode::TELEOP && teleop_refusal != motion::Reason::NONE) {
                answer.kind = motion::AnswerKind::REFUSED;
                answer.reason = teleop_refusal;
            } else {
                status.mode = mode_stuck ? status.mode : mode->mode;
            }
        } else if (std::holds_alternative<motion::JogStop>(command.body)) {
            log.emplace_back("jog stop");
        } else if (const auto *jog = std::get_if<motion::JogContinuous>(&command.body)) {
            log.push_back("jog " + std::to_string(jog->target.index));
            last_jog = *jog;
            answer.reason = jog_refusal;
            answer.kind =
                jog_refusal == motion::Reason::NONE ? motion::AnswerKind::DONE : motion::AnswerKind::REFUSED;
        } else if (const auto *on = std::get_if<motion::SpindleOn>(&command.body)) {
            log.push_back("spindle " + std::to_string(static_cast<int>(on->speed_rpm)));
        } else if (std::holds_alternative<motion::SpindleOff>(command.body)) {
            log.emplace_back("spindle off");
        } else if (const auto *p = std::get_if<motion::SetParameter>(&command.body)) {
            const bool is_type = p->parameter == static_cast<int>(motion::Parameter::TRAJ_PLANNER_TYPE);
            log.push_back((is_type ? "planner " : "setting ") + std::to_string(static_cast<int>(p->value)));
            answer.reason = setting_refusal;
            answer.kind = setting_refusal == motion::Reason::NONE ? motion::AnswerKind::DONE
                                                                  : motion::AnswerKind::REFUSED;
        }
        status.last_immediate_id = command.id;
        channels_.servo_answers.push(answer);
    }

    void take_path() {
        motion::PathCommand command;
        while (channels_.path.pop(command)) {
            const bool stale = command.epoch != status.epoch;
            motion::Answer answer{command.id, stale ? motion::AnswerKind::STALE : motion::AnswerKind::DONE};
            answer.isPath = true;
            const auto *line = std::get_if<motion::Line>(&command.body);
            if (!stale && line != nullptr && rejecting_moves) {
                answer.kind = motion::AnswerKind::REFUSED;
                answer.reason = motion::Reason::BEYOND_SOFT_LIMIT;
                answer.index = 0;
            } else if (!stale && line != nullptr) {
                corner_scale = line->terms.corner_scale;
                tolerance = line->terms.tolerance;
                status.carte_pos_cmd = line->end;
                log.push_back("line " + std::to_string(static_cast<int>(line->end.x())));
            }
            if (const auto *tap = std::get_if<motion::RigidTap>(&command.body); !stale && tap != nullptr) {
                last_tap = *tap;
                log.push_back("tap " + std::to_string(static_cast<int>(tap->end.z())));
            }
            status.last_path_id = stale ? status.last_path_id : command.id;
            channels_.planner_answers.push(answer);
        }
    }

    void publish() { channels_.status.write(status); }

    motion::Channels &channels_;
};

}  // namespace mw::task::test
