// SPDX-License-Identifier: GPL-2.0-or-later
// The machine as two processes: task here, motion and HAL threads in millwright-rt.
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <optional>

#include "base/memory_killer.hh"
#include "base/memory_reserve.hh"
#include "base/output_relay.hh"
#include "base/stop_signals.hh"
#include "base/thread_priority.hh"
#include "hal/host/host_client.hh"
#include "hal/script/programs.hh"
#include "machine/assembly/cycle_thread.hh"
#include "machine/assembly/lateness.hh"
#include "machine/assembly/machine.hh"
#include "machine/assembly/task_side.hh"

namespace mw::machine {
namespace {

constexpr std::int64_t NS_PER_S = 1000000000;
constexpr int CONFIGURE_CYCLES = 3000;
/// Per thread that runs task. A running program, a stop and their messages need less.
constexpr std::size_t HEAP_RESERVE = std::size_t{16} << 20;
/// Maximum wait for a call of the interpreter when the machine ends.
constexpr std::int64_t END_OF_CALL_NS = NS_PER_S / 5;

std::int64_t monotonic_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_PER_S + now.tv_nsec;
}

/// After a crash of task its realtime process brakes, switches the amplifiers off and ends. The next start
/// waits for this.
void wait_for_end_of(const std::string &instance) {
    constexpr std::int64_t PATIENCE_NS = 5 * NS_PER_S;
    constexpr timespec A_WHILE{0, 20000000};
    const std::int64_t end_ns = monotonic_ns() + PATIENCE_NS;
    while (hal::isHostAlive(instance) && monotonic_ns() < end_ns) {
        ::nanosleep(&A_WHILE, nullptr);
    }
}

class RealtimeMachine final : public Machine {
  public:
    explicit RealtimeMachine(const MachineParts &parts) : parts_(parts), next_ns_(monotonic_ns()) {}
    ~RealtimeMachine() override {
        if (cycles_.has_value() && !cycles_->end_call(END_OF_CALL_NS)) {
            end_beside_call();
        }
        cycles_.reset();
        side_.reset();
        shut_down();
    }

    Result<> start(const MachineOptions &options) {
        const std::string instance = options.instance.empty() ? hal::default_instance() : options.instance;
        wait_for_end_of(instance);
        // Created first, so that a second machine of this name is rejected before any driver is loaded.
        auto mailbox = mailbox::Memory::create(instance);
        if (!mailbox.has_value()) {
            return std::unexpected(mailbox.error());
        }
        static_cast<void>(raise_oom_score(TASK_OOM_STEP));
        auto host = hal::HostClient::start(instance, hal::MessagesTo::STDERR, hal::Lifetime::STARTER);
        if (!host.has_value()) {
            return std::unexpected(host.error());
        }
        host_ = std::move(*host);
        programs_.emplace(host_->hal(), &stop_signal);
        const auto controlled = host_->control();
        if (!controlled.has_value()) {
            return controlled;
        }
        side_ = std::make_unique<TaskSide>(parts_, *host_, std::move(*mailbox), &*programs_);
        const auto started = side_->start(options);
        if (started.has_value()) {
            cycles_.emplace(side_->task().long_call(),
                            CycleThread::Works{[this](std::int64_t now) { step_task(now); },
                                               [this](std::int64_t now) { side_->step_apart(now); }});
        }
        const auto finished = started.has_value() ? side_->finish_start(*this, CONFIGURE_CYCLES) : started;
        reserve_heap(HEAP_RESERVE);
        static_cast<void>(lock_present_memory());
        return finished;
    }

    void cycle() override {
        next_ns_ += parts_.config.task_period_ns;
        const std::int64_t now = monotonic_ns();
        if (next_ns_ < now) {
            next_ns_ = now;  // late: skips the missed cycles
        }
        cycles_->give_back();
        const timespec until{next_ns_ / NS_PER_S, next_ns_ % NS_PER_S};
        while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
        }
        cycles_->run(monotonic_ns());
        if (!watched_) {
            watched_ = true;
            raise_priority();
            raise_priority(cycles_->thread_id());
            lateness_.watch(::gettid());
            lateness_.watch(cycles_->thread_id());
        }
        if (const auto why = lateness_.step(monotonic_ns())) {
            side_->task().post(messages::MessageKind::OPERATOR_ERROR, *why);
        }
    }
    std::int64_t now_ns() const override { return monotonic_ns(); }
    bool isVirtual() const override { return false; }
    Result<> health() const override {
        auto death = host_->death();
        if (!death) {
            return {};
        }
        death->hint =
            "the drives have lost their commands: the machine is off only if its hardware switches it off";
        return std::unexpected(*death);
    }
    RealtimeFigures realtime_figures() const override {
        RealtimeFigures figures;
        figures.realtime = host_->hal().host_status().isRealtime();
        figures.missing = host_->hal().host_status().realtime_missing();
        for (const hal::ThreadInfo &thread : host_->hal().threads().list()) {
            figures.overruns += thread.overruns;
            figures.max_latency_ns = std::max(figures.max_latency_ns, thread.max_latency_ns);
        }
        return figures;
    }
    client::Client &client() override { return side_->client(); }
    mailbox::Segment &mailbox() override { return side_->mailbox(); }
    task::Task &task() override { return side_->task(); }
    journal::Writer *journal() override { return side_->journal(); }
    motion::Channels &channels() override { return side_->channels(); }
    hal::Instance &hal() override { return host_->hal(); }

  private:
    /// Runs in the thread of the cycles.
    void step_task(std::int64_t now_ns) {
        if (!reserved_) {
            reserved_ = true;
            reserve_heap(HEAP_RESERVE);
        }
        side_->step(now_ns);
    }
    void shut_down() {
        if (host_ != nullptr) {
            // Programs of loadusr use the HAL of this machine, so they end with it.
            if (programs_) {
                static_cast<void>(programs_->stop_all());
            }
            static_cast<void>(host_->shut_down());
        }
    }
    /// A script or a disk that does not respond still uses task, so task cannot be destroyed.
    [[noreturn]] void end_beside_call() {
        parts_.sink.error("the interpreter is still busy (a slow disk, or Python): the machine ends without "
                          "waiting for it");
        side_->remove_mailbox();
        side_->finish_files();
        shut_down();
        OutputRelay::end();
        std::_Exit(1);
    }

    MachineParts parts_;
    std::unique_ptr<hal::HostClient> host_;
    std::optional<hal::script::SystemProgramHost> programs_;
    std::unique_ptr<TaskSide> side_;
    std::optional<CycleThread> cycles_;
    Lateness lateness_;
    bool watched_ = false;
    bool reserved_ = false;  ///< used only in the thread of the cycles
    std::int64_t next_ns_;
};

}  // namespace

Result<std::unique_ptr<Machine>> make_realtime_machine(const MachineParts &parts,
                                                       const MachineOptions &options) {
    auto machine = std::make_unique<RealtimeMachine>(parts);
    const auto started = machine->start(options);
    if (!started.has_value()) {
        return std::unexpected(started.error());
    }
    return machine;
}

}  // namespace mw::machine
