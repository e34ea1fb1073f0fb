// SPDX-License-Identifier: GPL-2.0-or-later
// A client that switches a machine on, homes it, moves it, and reports the duration of its commands. It uses
// NML channels (of the configuration) or the mailbox of a machine on this computer.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/diagnostics/sink.hh"
#include "base/options/command_line.hh"
#include "clients/nml/bridge/bridge.hh"
#include "clients/nml/bridge/channel.hh"
#include "clients/nml/buffer/shared_lock.hh"
#include "clients/nml/config/config_file.hh"
#include "messages/client/client.hh"

namespace mw {
namespace {

constexpr double STEP_S = 40;
constexpr double LEAST_MOVE_MM = 1e-6;

/// The result of a command, with times since it was posted.
struct Course {
    bool isDone = false;
    std::string reason;
    std::int64_t taken_ns = -1, motion_ns = -1;
};

/// One of the two connections to a machine.
class Way {
  public:
    virtual ~Way() = default;
    virtual Course carry_out(const messages::Command &command) = 0;
    virtual const messages::MachineStatus &status() const = 0;
    virtual bool see_status() = 0;
};

class ByNml final : public Way {
  public:
    static std::unique_ptr<ByNml> open(const std::string &file, const std::string &process) {
        auto way = std::unique_ptr<ByNml>(new ByNml);
        diagnostics::Sink sink([](const diagnostics::Diagnostic &d) { fmt::print(stderr, "{}\n", d.str()); });
        auto config = nml::load_config(file, sink);
        if (!config.has_value()) {
            return nullptr;
        }
        way->config_ = std::move(*config);
        const nml::Connections mine{way->config_, process, "no-instance", way->vocabulary_, way->local_};
        auto commands = nml::Channel::open(mine, nml::COMMAND_CHANNEL);
        auto statuses = nml::Channel::open(mine, nml::STATUS_CHANNEL);
        if (!commands.has_value() || !statuses.has_value()) {
            fmt::print(stderr, "{}\n", (commands.has_value() ? statuses.error() : commands.error()).str());
            return nullptr;
        }
        way->commands_ = std::make_unique<nml::Channel>(std::move(*commands));
        way->statuses_ = std::make_unique<nml::Channel>(std::move(*statuses));
        return way;
    }

    const messages::MachineStatus &status() const override {
        return *message_->get<messages::MachineStatus>();
    }
    bool see_status() override {
        auto read = statuses_->wait(nml::Timeout{1.0});
        if (read.has_value() && !read->has_value()) {
            read = statuses_->peek();
        }
        if (!read.has_value() || !read->has_value()) {
            return false;
        }
        message_ = std::move(*read);
        return message_->get<messages::MachineStatus>() != nullptr;
    }
    Course carry_out(const messages::Command &command) override {
        Course course;
        const geometry::Pose from = status().trajectory.position_cmd;
        const std::int64_t posted_ns = nml::monotonic_ns();
        const auto written = std::visit(
            [this](const auto &body) {
                nml::CommandMessage<std::decay_t<decltype(body)>> message{{}, body};
                return commands_->write(nml::view(message));
            },
            command);
        if (!written.has_value()) {
            course.reason = written.error().str();
            return course;
        }
        while (nml::monotonic_ns() < posted_ns + static_cast<std::int64_t>(STEP_S * 1e9) && see_status()) {
            const std::int64_t now_ns = nml::monotonic_ns() - posted_ns;
            const nml::StatusHead &head = *message_->status_head();
            if (head.echo_serial_number != *written) {
                continue;
            }
            course.taken_ns = course.taken_ns < 0 ? now_ns : course.taken_ns;
            const bool isAway = geometry::norm_xyz(status().trajectory.position_cmd - from) > LEAST_MOVE_MM;
            course.motion_ns = isAway && course.motion_ns < 0 ? now_ns : course.motion_ns;
            if (head.state != nml::CommandState::EXECUTING) {
                course.isDone = head.state == nml::CommandState::DONE;
                course.reason = head.reason.str();
                return course;
            }
        }
        course.reason = "no answer";
        return course;
    }

  private:
    ByNml() = default;
    nml::Config config_;
    nml::Vocabulary vocabulary_ = nml::Vocabulary::standard();
    nml::LocalPlaces local_;
    std::unique_ptr<nml::Channel> commands_, statuses_;
    mutable std::optional<nml::Message> message_;  ///< reading a message may change it
};

class ByMailbox final : public Way {
  public:
    explicit ByMailbox(client::Client client) : client_(std::move(client)) {}
    const messages::MachineStatus &status() const override { return client_.status(); }
    bool see_status() override { return client_.wait_status(1.0).has_value(); }
    Course carry_out(const messages::Command &command) override {
        Course course;
        static_cast<void>(client_.read_status());
        const geometry::Pose from = status().trajectory.position_cmd;
        const std::int64_t posted_ns = nml::monotonic_ns();
        const auto serial = client_.post(command);
        if (!serial.has_value()) {
            course.reason = serial.error().str();
            return course;
        }
        if (!client_.wait_taken(*serial, STEP_S).has_value()) {
            course.reason = "no answer";
            return course;
        }
        course.taken_ns = nml::monotonic_ns() - posted_ns;
        client::Outcome outcome;
        const auto isOver = [&] {
            outcome = client_.outcome(*serial);
            static_cast<void>(client_.read_status());
            const bool isAway = geometry::norm_xyz(status().trajectory.position_cmd - from) > LEAST_MOVE_MM;
            course.motion_ns =
                isAway && course.motion_ns < 0 ? nml::monotonic_ns() - posted_ns : course.motion_ns;
            return outcome.progress != messages::Progress::STARTED;
        };
        static_cast<void>(client_.wait_until(isOver, STEP_S));
        course.isDone = outcome.progress == messages::Progress::DONE;
        course.reason = outcome.reason;
        return course;
    }

  private:
    client::Client client_;
};

bool prepare(Way &way) {
    const messages::Command commands[] = {
        messages::SetState{messages::State::ESTOP_RESET}, messages::SetState{messages::State::ON},
        messages::SetMode{messages::Mode::MANUAL},        messages::HomeJoint{},
        messages::SetMode{messages::Mode::MDI},           messages::Mdi{"G21 G90 G53 G0 X7.5"}};
    for (const messages::Command &command : commands) {
        const bool isDone =
            std::holds_alternative<messages::HomeJoint>(command) && way.status().trajectory.isAllHomed;
        if (isDone) {
            continue;
        }
        const Course course = way.carry_out(command);
        if (!course.isDone) {
            fmt::print("command {} failed: {}\n", command.index(), course.reason);
            return false;
        }
    }
    return way.see_status();
}

void tell(const char *what, std::vector<std::int64_t> times) {
    std::ranges::sort(times);
    constexpr double MS = 1e-6;
    const auto at = [&](std::size_t thousandths) {
        return MS * static_cast<double>(times[std::min(times.size() - 1, times.size() * thousandths / 1000)]);
    };
    fmt::print("{}: median {:.2f} ms, 99 % {:.2f} ms, most {:.2f} ms\n", what, at(500), at(990), at(1000));
}

/// Short moves back and forth.
bool measure(Way &way, int count) {
    std::vector<std::int64_t> taken, motion;
    for (int i = 0; i < count; ++i) {
        const Course course = way.carry_out(messages::Mdi{i % 2 == 0 ? "G53 G0 X8.5" : "G53 G0 X7.5"});
        if (!course.isDone || course.motion_ns < 0) {
            fmt::print("move {} failed: {}\n", i, course.reason);
            return false;
        }
        taken.push_back(course.taken_ns);
        motion.push_back(course.motion_ns);
    }
    tell("acknowledged", std::move(taken));
    tell("motion begun", std::move(motion));
    return true;
}

int run(int argc, char **argv) {
    std::string file, process = "xemc", instance;
    int count = 0;
    options::CommandLine line("command_client [options]", "Operates a machine and measures its answers.\n");
    line.text("--nml", "FILE", "go through the channels of this configuration", file);
    line.text("--process", "NAME", "whose P lines say how", process);
    line.text("--instance", "NAME", "go through the mailbox of this machine", instance);
    line.number("--count", "N", "moves that are measured", count, 0, 1000000);
    const auto parsed = line.parse({argv + 1, argv + argc});
    if (!parsed.has_value()) {
        fmt::print(stderr, "{}\n", parsed.error().str());
        return 2;
    }
    std::unique_ptr<Way> way;
    if (!file.empty()) {
        way = ByNml::open(file, process);
    } else if (auto client = client::Client::connect(instance); client.has_value()) {
        way = std::make_unique<ByMailbox>(std::move(*client));
    }
    if (way == nullptr || !way->see_status() || !prepare(*way)) {
        return 1;
    }
    fmt::print("homed {}, at X{:.4f}\n", way->status().trajectory.isAllHomed,
               way->status().trajectory.position_cmd[0]);
    return count == 0 || measure(*way, count) ? 0 : 1;
}

}  // namespace
}  // namespace mw

int main(int argc, char **argv) {
    return mw::run(argc, argv);
}
