// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesa_campaign/session.hh"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "drivers/mesa/test/rig.hh"

namespace mw::mesa_campaign {

namespace {

using mesa::test::Rig;

constexpr double PERIOD_S = 1e-3;
constexpr std::int64_t MS = 1'000'000;
constexpr std::int64_t STEPS_PER_REV = 200, COUNTS_PER_STEP = 20;
/// The index is at 0.25 revolutions.
constexpr std::int64_t INDEX_STEPS = STEPS_PER_REV / 4;
constexpr const char *PHYSICS =
    "motor x stepgen=0 steps_per_rev=200\nencoder 0 motor=x counts_per_rev=4000 index_rev=0.25\n";
/// Fraction of the travel of failed cycles that a step generator recovers per cycle.
constexpr double CATCHING_UP = 0.002;

/// Accelerates at random within limits; stop() brakes to standstill.
class Command {
  public:
    explicit Command(const Plan &plan) : plan_(plan), random_(plan.seed) {}

    double next(bool moving) {
        const double step = plan_.accel * PERIOD_S;
        if (!moving) {
            velocity_ -= std::clamp(velocity_, -step, step);
        } else {
            if (--left_ <= 0) {
                left_ = std::uniform_int_distribution<int>(20, 300)(random_);
                part_ = std::uniform_real_distribution<double>(-1, 1)(random_);
            }
            velocity_ = std::clamp(velocity_ + part_ * step, -plan_.speed, plan_.speed);
        }
        position_ += velocity_ * PERIOD_S;
        return position_;
    }
    void restart_at(double position) {
        position_ = position;
        velocity_ = 0;
    }
    double position() const { return position_; }
    bool isResting() const { return velocity_ == 0; }

  private:
    const Plan &plan_;
    std::mt19937 random_;
    int left_ = 0;
    double part_ = 0, velocity_ = 0, position_ = 0;
};

/// Rule 3: follows the shaft while the index is armed.
class IndexJudge {
  public:
    void arm(std::int64_t steps) {
        armed_ = true;
        low_ = high_ = written_low_ = written_high_ = steps;
        good_cycles_ = 0;
        crossed_at_ = -1;
    }
    /// The board has lost its registers: its earlier values do not count.
    void restart() { lost_ = armed_; }
    bool isArmed() const { return armed_; }

    /// A cycle in which the index was not latched; empty: no fault.
    std::string wait(std::int64_t steps, bool good) {
        low_ = std::min(low_, steps);
        high_ = std::max(high_, steps);
        good_cycles_ += good ? 1 : 0;
        if (good_cycles_ < WRITTEN) {
            written_low_ = written_high_ = steps;
        }
        written_low_ = std::min(written_low_, steps);
        written_high_ = std::max(written_high_, steps);
        // On the index itself, its level has changed once; the polarity selects the edge that latches.
        if (crossed_at_ < 0 && revolution(written_low_ + 1) < revolution(written_high_ - 2)) {
            crossed_at_ = good_cycles_;
        }
        const bool missed = !lost_ && crossed_at_ >= 0 && good_cycles_ - crossed_at_ > PATIENCE;
        return missed ? "index: the shaft has passed the index and nothing is latched" : "";
    }
    /// The index was latched when the shaft had made `latched` steps.
    std::string take(std::int64_t latched, std::int64_t steps) {
        armed_ = false;
        low_ = std::min(low_, steps);
        high_ = std::max(high_, steps);
        const bool lost = std::exchange(lost_, false);
        const std::int64_t off = ((latched - INDEX_STEPS) % STEPS_PER_REV + STEPS_PER_REV) % STEPS_PER_REV;
        if (off > 1 && off < STEPS_PER_REV - 1) {
            return fmt::format("index: latched {} steps off", off);
        }
        if (!lost && (latched < low_ - MOVE_OF_A_CYCLE || latched > high_ + MOVE_OF_A_CYCLE)) {
            return fmt::format("index: latched at step {}, the shaft was from {} to {}", latched, low_,
                               high_);
        }
        return {};
    }

  private:
    static std::int64_t revolution(std::int64_t steps) {
        return static_cast<std::int64_t>(
            std::floor(static_cast<double>(steps - INDEX_STEPS) / static_cast<double>(STEPS_PER_REV)));
    }
    /// Good cycles after which an arm has reached the board, and after which a latch has been returned.
    static constexpr int WRITTEN = 3, PATIENCE = 30;
    static constexpr std::int64_t MOVE_OF_A_CYCLE = 25;

    bool armed_ = false, lost_ = false;
    std::int64_t low_ = 0, high_ = 0;                  ///< steps of the shaft since the arm
    std::int64_t written_low_ = 0, written_high_ = 0;  ///< since the board has received the arm
    int good_cycles_ = 0, crossed_at_ = -1;
};

class Session {
  public:
    Session(const Plan &plan, std::FILE *told)
        : plan_(plan), told_(told), rig_({.config = "num_stepgens=1 num_encoders=1", .physics = PHYSICS}),
          command_(plan), random_(plan.seed + 1) {
        const auto faults = mesa::board::parse_faults(plan.network, "network");
        if (!faults) {
            fail(faults.error().str());
            return;
        }
        rig_.link.disturb(faults->to_board, faults->to_host, plan.seed);
        tell(plan.network);
        const std::string axis = "stepgen.00.";
        rig_.pins.set(axis + "position-scale", plan.steps_per_mm);
        rig_.pins.set(axis + "steplen", 2000);
        rig_.pins.set(axis + "stepspace", 2000);
        rig_.pins.set(axis + "dirsetup", 1000);
        rig_.pins.set(axis + "dirhold", 1000);
        rig_.pins.set(axis + "maxaccel", plan.max_accel);
        rig_.pins.set(axis + "enable", 1);
        rig_.pins.set("watchdog.timeout_ns", plan.watchdog_ms * MS);
    }

    Verdict run() {
        for (const Act &act : plan_.acts) {
            for (int i = 0; i < act.moving_cycles && good(); ++i) {
                cycle(true);
            }
            perform(act);
            for (int i = 0; i < act.resting_cycles && good(); ++i) {
                cycle(false);
            }
        }
        for (int i = 0; i < 10'000 && good() && state_ != State::RUNNING; ++i) {
            cycle(false);
        }
        if (good() && plan_.usable && state_ != State::RUNNING) {
            fail("end: the machine does not move again");
        }
        return verdict_;
    }

  private:
    enum class State : std::uint8_t {
        RUNNING,
        FAULTED,   ///< the operator has not noticed the fault yet
        CLEARING,  ///< the operator has cleared the fault and checks whether it returns
    };

    bool good() const { return verdict_.fault.empty(); }
    std::int64_t now() const { return rig_.transport->now_ns(); }
    std::int64_t steps() const { return rig_.steps(0); }
    void fail(const std::string &fault) {
        if (good()) {
            verdict_.fault = fmt::format("{} (cycle {})", fault, verdict_.cycles);
        }
    }
    void tell(const std::string &what) const {
        if (told_ != nullptr) {
            fmt::print(told_, "{:9.3f} ms cycle {}: {}\n", static_cast<double>(now()) / MS, verdict_.cycles,
                       what);
        }
    }
    /// Time after which the watchdog of the board trips if nothing is written.
    std::int64_t watchdog_ns() const {
        return plan_.watchdog_ms * MS + Rig::PERIOD_NS + plan_.max_delay_ns + MS / 2;
    }

    void cycle(bool moving) {
        ++verdict_.cycles;
        rig_.read();
        loss_ = rig_.driver->take_position_loss();
        const bool failed = rig_.bus->isFailed() || rig_.bus->isStopped();
        verdict_.failed_cycles += failed ? 1 : 0;
        failed_run_ = failed ? failed_run_ + 1 : 0;
        const bool faulted = rig_.bus->isStopped() || rig_.pins.get("watchdog.has_bit") != 0.0;
        judge_positions(faulted);
        if (faulted && state_ != State::FAULTED) {
            begin_fault();
        }
        switch (state_) {
        case State::RUNNING: follow(moving); break;
        case State::FAULTED: wait_for_operator(); break;
        case State::CLEARING: look_after_clearing(failed); break;
        }
        judge_index(!failed);
        rig_.write();
    }

    /// Rule 4.
    void judge_positions(bool faulted) {
        verdict_.losses += loss_ != mesa::PositionLoss::NONE ? 1 : 0;
        if (!isFollowed_) {
            isFollowed_ = !faulted && failed_run_ == 0;
            return;  // no positions exist yet
        }
        if (state_ == State::RUNNING && faulted && loss_ == mesa::PositionLoss::NONE) {
            fail("positions: their loss is not reported with a fault");
        }
        if (state_ == State::RUNNING && !faulted && !restart_untold_ && loss_ != mesa::PositionLoss::NONE) {
            fail("positions: their loss is reported without a cause");
        }
        if (loss_ == mesa::PositionLoss::RESTARTED) {
            if (!restart_untold_) {
                fail("positions: a restart of the board is reported that was none");
            }
            restart_untold_ = false;
        }
    }

    void begin_fault() {
        const bool stopped = rig_.bus->isStopped();
        verdict_.stops += stopped ? 1 : 0;
        verdict_.bites += stopped ? 0 : 1;
        tell(stopped ? "the traffic is stopped" : "the watchdog has bitten");
        if (state_ == State::RUNNING) {
            still_ns_ = now() + watchdog_ns();
            still_steps_ = NOT_STILL;
        }
        state_ = State::FAULTED;
        operator_ns_ = now() + plan_.reaction_ms * MS;
        rig_.pins.set("stepgen.00.enable", 0);
    }

    /// Maximum deviation of a motor at a stale rate from its command, and the time until it has caught up
    /// [mm].
    double way_of_failures() const {
        const double time_s = (failed_run_ + 2) * PERIOD_S;
        const double velocity = std::min(plan_.accel * time_s, 2 * plan_.speed);
        return 2 * plan_.speed * time_s + velocity * velocity / (2 * (plan_.max_accel - plan_.accel));
    }

    /// Rule 1.
    void follow(bool moving) {
        rig_.pins.set("stepgen.00.position-cmd", command_.next(moving));
        allowed_steps_ =
            std::max(way_of_failures() * plan_.steps_per_mm + 2, allowed_steps_ * (1 - CATCHING_UP));
        const double off = std::abs(static_cast<double>(steps()) - start_steps_ -
                                    (command_.position() - start_mm_) * plan_.steps_per_mm);
        verdict_.worst_steps = std::max(verdict_.worst_steps, off / allowed_steps_);
        if (off > allowed_steps_) {
            fail(fmt::format("following: the motor is {:.1f} steps off, {:.1f} are allowed", off,
                             allowed_steps_));
        }
        resting_cycles_ = command_.isResting() ? resting_cycles_ + 1 : 0;
        constexpr int SETTLED = 700;
        if (resting_cycles_ > SETTLED && failed_run_ == 0 && off > 1.0) {
            fail(fmt::format("rest: the motor is {:.2f} steps off", off));
        }
        if (resting_cycles_ > SETTLED && failed_run_ == 0) {
            measure_frame();
        }
    }

    /// Rule 2.
    void require_standstill() {
        if (now() < still_ns_) {
            return;
        }
        if (still_steps_ == NOT_STILL) {
            still_steps_ = steps();
        } else if (steps() != still_steps_) {
            fail(fmt::format("fault: the motor has moved by {} steps before an operator acted",
                             steps() - still_steps_));
        }
    }

    void wait_for_operator() {
        require_standstill();
        command_.restart_at(rig_.pins.get("stepgen.00.position-fb"));
        rig_.pins.set("stepgen.00.position-cmd", command_.position());
        if (now() < operator_ns_) {
            return;
        }
        tell("the operator clears the fault");
        rig_.bus->resume();
        rig_.pins.set("watchdog.has_bit", 0);
        state_ = State::CLEARING;
        cleared_cycles_ = 0;
    }

    void look_after_clearing(bool failed) {
        require_standstill();
        command_.restart_at(rig_.pins.get("stepgen.00.position-fb"));
        rig_.pins.set("stepgen.00.position-cmd", command_.position());
        constexpr int CONVINCED = 50;
        if (++cleared_cycles_ < CONVINCED || failed || now() < still_ns_) {
            return;
        }
        tell("the operator enables the axis");
        if (restart_untold_) {
            fail("positions: the restart of the board is not reported");
        }
        state_ = State::RUNNING;
        start_mm_ = command_.position();
        start_steps_ = static_cast<double>(steps());
        // The step generator counts whole steps, the position does not.
        allowed_steps_ = 0;
        resting_cycles_ = 0;
        measure_frame();
        rig_.pins.set("stepgen.00.enable", 1);
    }

    /// The shaft is stopped: measures the relation between encoder counts and steps.
    void measure_frame() {
        frame_counts_ =
            static_cast<std::int64_t>(rig_.pins.get("encoder.00.rawcounts")) - COUNTS_PER_STEP * steps();
        frame_known_ = true;
    }

    void judge_index(bool good_cycle) {
        if (!index_.isArmed()) {
            if (state_ == State::RUNNING && frame_known_ &&
                std::bernoulli_distribution(plan_.arm_probability)(random_)) {
                ++verdict_.arms;
                rig_.pins.set("encoder.00.index-enable", 1);
                index_.arm(steps());
            }
            return;
        }
        if (rig_.pins.get("encoder.00.index-enable") != 0.0) {
            const std::string fault = index_.wait(steps(), good_cycle);
            if (!fault.empty()) {
                fail(fault);
            }
            return;
        }
        ++verdict_.latches;
        const auto raw = static_cast<std::int64_t>(rig_.pins.get("encoder.00.rawlatch"));
        const double latched = static_cast<double>(raw - frame_counts_) / COUNTS_PER_STEP;
        const std::string fault = index_.take(std::llround(latched), steps());
        if (!fault.empty() && frame_known_) {
            fail(fault);
        }
    }

    void perform(const Act &act) {
        if (!good() || act.trouble == Trouble::NONE) {
            return;
        }
        tell(fmt::format("trouble {} for {} ms", static_cast<int>(act.trouble), act.trouble_ms));
        const std::int64_t duration_ns = act.trouble_ms * MS;
        switch (act.trouble) {
        case Trouble::NONE: return;
        case Trouble::HOST_SILENT: be_silent(duration_ns); return;
        case Trouble::LINK_DOWN: happen(mesa::board::FaultType::LINK_DOWN, duration_ns); break;
        case Trouble::POWER_OFF: lose_registers(mesa::board::FaultType::POWER_OFF, duration_ns); break;
        case Trouble::RESET: lose_registers(mesa::board::FaultType::RESET, 0); break;
        case Trouble::WATCHDOG: happen(mesa::board::FaultType::WATCHDOG, 0); break;
        }
        for (int i = 0; i < act.trouble_ms && good(); ++i) {
            cycle(true);
        }
    }

    void happen(mesa::board::FaultType type, std::int64_t duration_ns) {
        rig_.link.perform({.type = type, .at_ns = now(), .duration_ns = duration_ns});
    }
    void lose_registers(mesa::board::FaultType type, std::int64_t duration_ns) {
        frame_known_ = false;
        restart_untold_ = true;
        index_.restart();
        happen(type, duration_ns);
    }

    void be_silent(std::int64_t duration_ns) {
        const std::int64_t first_ns = std::min(duration_ns, watchdog_ns());
        rig_.wait(first_ns);
        // The motor keeps its last rate until the watchdog trips, and then moves back.
        allowed_steps_ += plan_.steps_per_mm * (plan_.speed * static_cast<double>(first_ns) * 1e-9 +
                                                plan_.speed * plan_.speed / (2 * plan_.max_accel));
        if (duration_ns == first_ns) {
            return;
        }
        const std::int64_t before = steps();
        rig_.wait(duration_ns - first_ns);
        if (steps() != before) {
            fail(fmt::format("silence: the motor has moved by {} steps after the watchdog time",
                             steps() - before));
        }
    }

    static constexpr std::int64_t NOT_STILL = INT64_MIN;

    const Plan &plan_;
    std::FILE *told_;
    Rig rig_;
    Command command_;
    std::mt19937 random_;
    IndexJudge index_;
    Verdict verdict_;
    State state_ = State::RUNNING;
    std::int64_t operator_ns_ = 0, still_ns_ = 0, still_steps_ = NOT_STILL;
    double start_mm_ = 0, start_steps_ = 0, allowed_steps_ = 0;
    int failed_run_ = 0, resting_cycles_ = 0, cleared_cycles_ = 0;
    std::int64_t frame_counts_ = 0;
    bool frame_known_ = true;
    mesa::PositionLoss loss_ = mesa::PositionLoss::NONE;  ///< loss in this cycle
    bool restart_untold_ = false, isFollowed_ = false;
};

}  // namespace

Verdict run_session(const Plan &plan, std::FILE *told) {
    return Session(plan, told).run();
}

}  // namespace mw::mesa_campaign
