// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/schedule/scheduler.hh"

#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "messages/legacy/units.hh"

namespace mw::schedule {
namespace {

using messages::Progress;

/// Zones 1 to 9.
constexpr std::array<const char *, 9> SYSTEMS{"G54", "G55",   "G56",   "G57",  "G58",
                                              "G59", "G59.1", "G59.2", "G59.3"};

std::string origin_of(const Job &job) {
    if (job.zone > 0) {
        return fmt::format("{} G52 X0 Y0 Z0", SYSTEMS[static_cast<std::size_t>(job.zone - 1)]);
    }
    return fmt::format("G54 G52 X{:.6f} Y{:.6f} Z{:.6f}", job.x, job.y, job.z);
}

std::string why_not_ready(const messages::MachineStatus &status) {
    if (status.task.state != messages::State::ON) {
        return "the machine is not on";
    }
    if (status.task.interp_state != messages::InterpState::IDLE) {
        return "a program or line runs already";
    }
    return {};
}

}  // namespace

std::deque<messages::Command> commands_for(const Job &job, const std::string &folder,
                                           const messages::MachineStatus &status) {
    std::filesystem::path path(job.file);
    if (path.is_relative()) {
        std::error_code error;
        path = std::filesystem::absolute(std::filesystem::path(folder) / path, error).lexically_normal();
    }
    std::deque<messages::Command> commands;
    commands.emplace_back(messages::SetMode{messages::Mode::MDI});
    if (job.tool > 0 && job.tool != status.tool.in_spindle) {
        commands.emplace_back(messages::Mdi{fmt::format("T{} M6", job.tool)});
    }
    if (job.tool > 0) {
        commands.emplace_back(messages::Mdi{"G43"});
    }
    commands.emplace_back(messages::Mdi{origin_of(job)});
    commands.emplace_back(messages::SetFeedOverride{legacy::factor(job.feed_percent)});
    for (int spindle = 0; spindle < status.trajectory.num_spindles; ++spindle) {
        commands.emplace_back(messages::SetSpindleOverride{legacy::factor(job.spindle_percent), spindle});
    }
    commands.emplace_back(messages::SetMode{messages::Mode::AUTO});
    commands.emplace_back(messages::OpenProgram{path.string()});
    commands.emplace_back(messages::RunProgram{0});
    return commands;
}

Result<> Scheduler::run(const messages::MachineStatus &status) {
    if (mode_ == QueueMode::RUN) {
        return {};
    }
    if (mode_ == QueueMode::PAUSE) {
        return resume();
    }
    if (const std::string why = why_not_ready(status); !why.empty() && !queue_.jobs().empty()) {
        return fail(why);
    }
    error_.clear();
    mode_ = QueueMode::RUN;
    looked_s_ = -1e9;
    return {};
}

Result<> Scheduler::pause() {
    if (work_.has_value()) {
        if (auto posted = commander_.post(messages::PauseProgram{}); !posted.has_value()) {
            return std::unexpected(posted.error());
        }
    }
    mode_ = QueueMode::PAUSE;
    return {};
}

Result<> Scheduler::resume() {
    if (mode_ != QueueMode::PAUSE) {
        return fail("the queue is not paused");
    }
    if (work_.has_value()) {
        if (auto posted = commander_.post(messages::ResumeProgram{}); !posted.has_value()) {
            return std::unexpected(posted.error());
        }
    }
    mode_ = QueueMode::RUN;
    return {};
}

Result<> Scheduler::stop() {
    const bool working = work_.has_value();
    work_.reset();
    mode_ = QueueMode::STOP;
    error_.clear();
    if (working) {
        if (auto posted = commander_.post(messages::AbortAll{}); !posted.has_value()) {
            return std::unexpected(posted.error());
        }
    }
    return {};
}

Result<> Scheduler::remove(int tag) {
    if (work_.has_value() && work_->tag == tag) {
        return fail("this program runs: stop the queue first");
    }
    return queue_.remove(tag) ? Result<>{} : fail(fmt::format("no program has the tag {}", tag));
}

void Scheduler::step(const messages::MachineStatus &status, double now_s) {
    look_at_work();
    if (mode_ != QueueMode::RUN || work_.has_value() || now_s - looked_s_ < poll_s) {
        return;
    }
    looked_s_ = now_s;
    if (queue_.jobs().empty()) {
        mode_ = QueueMode::STOP;
        return;
    }
    if (const std::string why = why_not_ready(status); !why.empty()) {
        fall_into_error(why);
        return;
    }
    begin(queue_.jobs().front(), status);
}

void Scheduler::begin(const Job &job, const messages::MachineStatus &status) {
    work_ = Work{job.tag, commands_for(job, folder_, status), {}};
    post_next();
}

void Scheduler::post_next() {
    const auto posted = commander_.post(work_->ahead.front());
    if (!posted.has_value()) {
        fall_into_error(posted.error().str());
        return;
    }
    work_->ahead.pop_front();
    work_->under_way = *posted;
}

void Scheduler::look_at_work() {
    while (work_.has_value() && work_->under_way.has_value()) {
        const client::Outcome outcome = commander_.outcome(*work_->under_way);
        switch (outcome.progress) {
        case Progress::STARTED: return;
        case Progress::REFUSED:
        case Progress::FAILED:
            fall_into_error(outcome.reason.empty() ? "the program was aborted" : outcome.reason);
            return;
        case Progress::DONE: break;
        }
        if (work_->ahead.empty()) {
            queue_.remove(work_->tag);
            work_.reset();
            looked_s_ = -1e9;
        } else if (mode_ != QueueMode::PAUSE) {
            post_next();
        } else {
            return;  // no command is sent during a pause
        }
    }
}

void Scheduler::fall_into_error(const std::string &why) {
    error_ = work_.has_value() ? fmt::format("program {}: {}", work_->tag, why) : why;
    work_.reset();
    mode_ = QueueMode::ERROR;
}

}  // namespace mw::schedule
