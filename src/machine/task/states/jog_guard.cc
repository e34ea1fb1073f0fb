// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/states/jog_guard.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/geometry/pose.hh"
#include "messages/mailbox/memory.hh"

namespace mw::task {
namespace {

std::string name_of(const std::optional<std::pair<bool, int>> &target) {
    if (!target.has_value()) {
        return "all axes";
    }
    const auto [isJoint, index] = *target;
    return isJoint ? fmt::format("joint {}", index)
                   : fmt::format("axis {}", geometry::AXIS_LETTERS[static_cast<std::size_t>(index)]);
}

Command stop_of(const std::optional<std::pair<bool, int>> &target) {
    return target.has_value() ? Command(JogStop{target->first, target->second}) : Command(SetTeleopVector{});
}

bool moves(const motion::Status &motion, const std::optional<std::pair<bool, int>> &target) {
    if (!target.has_value()) {
        return std::ranges::any_of(motion.axis, [](const auto &axis) { return axis.velocity != 0.0; });
    }
    const auto index = static_cast<std::size_t>(target->second);
    return target->first ? motion.joint[index].vel_cmd != 0.0 : motion.axis[index].velocity != 0.0;
}

std::string text_of(const std::optional<std::pair<bool, int>> &target, std::uint64_t owner,
                    JogGuard::State state) {
    const int pid = mailbox::pid_of(owner);
    return state == JogGuard::State::ENDED
               ? fmt::format("Jog of {} stopped: its client, process {}, has ended.", name_of(target), pid)
               : fmt::format("Jog of {} stopped: its client, process {}, is suspended.", name_of(target),
                             pid);
}

}  // namespace

void JogGuard::note(const Command &command, std::uint64_t owner) {
    std::visit(
        [&]<class C>(const C &one) {
            if constexpr (OneOf<C, JogContinuous>) {
                if (!one.isRenewal) {
                    begin(std::pair(one.isJoint, one.index), owner);
                }
            } else if constexpr (OneOf<C, SetTeleopVector>) {
                begin(std::nullopt, one.velocity != geometry::Pose{} ? owner : 0);
            } else if constexpr (OneOf<C, JogIncrement, JogAbsolute, JogStop>) {
                end(std::pair(one.isJoint, one.index));
            } else if constexpr (OneOf<C, AbortAll, SetState>) {
                end_all();
            }
        },
        command);
}

void JogGuard::begin(const Target &target, std::uint64_t owner) {
    end(target);
    if (owner != 0) {
        jogs_[target] = {owner};
    }
}

void JogGuard::end(const Target &target) {
    const auto found = jogs_.find(target);
    if (found != jogs_.end()) {
        const std::uint64_t owner = found->second.owner;
        jogs_.erase(found);
        forget_unused(owner);
    }
}

void JogGuard::end_all() {
    while (!jogs_.empty()) {
        end(jogs_.begin()->first);
    }
}

void JogGuard::forget_unused(std::uint64_t owner) {
    if (std::ranges::none_of(jogs_, [owner](const auto &jog) { return jog.second.owner == owner; })) {
        watch_.forget(owner);
    }
}

std::vector<JogGuard::Left> JogGuard::step(const motion::Status &motion) {
    std::vector<Left> left;
    std::vector<Target> over;
    for (auto &[target, jog] : jogs_) {
        const bool moving = moves(motion, target);
        jog.moved = jog.moved || moving;
        const State state = watch_.state_of(jog.owner);
        if (state != State::RUNNING) {
            left.push_back({stop_of(target), moving ? text_of(target, jog.owner, state) : ""});
            over.push_back(target);
        } else if (jog.moved && !moving) {  // stopped at a limit
            over.push_back(target);
        }
    }
    for (const Target &target : over) {
        end(target);
    }
    return left;
}

}  // namespace mw::task
