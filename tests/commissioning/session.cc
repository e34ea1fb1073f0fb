// SPDX-License-Identifier: GPL-2.0-or-later
#include "commissioning/session.hh"

#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "base/ini/ini_file.hh"
#include "commissioning/owner.hh"
#include "commissioning/true_machine.hh"
#include "commissioning/world.hh"
#include "programs/commission/commissioner.hh"
#include "programs/run/run_session.hh"
#include "programs/setup/new_machine.hh"

namespace mw::commissioning_campaign {
namespace {

using commissioning::Bench;
using commissioning::Finding;

/// A computer whose servo thread is late.
class LateBench final : public Bench {
  public:
    explicit LateBench(Bench &bench) : bench_(bench) {}
    double now_s() const override { return bench_.now_s(); }
    bool isOn() const override { return bench_.isOn(); }
    bool isEstopReleased() const override { return bench_.isEstopReleased(); }
    bool isProbeOn() const override { return bench_.isProbeOn(); }
    commissioning::JointReading joint(int joint) const override { return bench_.joint(joint); }
    std::uint64_t late_cycles() const override { return static_cast<std::uint64_t>(bench_.now_s()); }
    std::string last_error() const override { return bench_.last_error(); }
    void switch_on(const std::vector<int> &joints) override { bench_.switch_on(joints); }
    double worst_latency_s() const override { return bench_.worst_latency_s(); }
    void switch_off() override { bench_.switch_off(); }
    void move_to(int joint, double position, double speed) override {
        bench_.move_to(joint, position, speed);
    }
    void stop(int joint) override { bench_.stop(joint); }
    void home(int joint) override { bench_.home(joint); }
    void unhome(int joint) override { bench_.unhome(joint); }
    void run_spindle(double speed_rpm) override { bench_.run_spindle(speed_rpm); }
    void stop_spindle() override { bench_.stop_spindle(); }
    std::optional<double> value(std::string_view name) const override { return bench_.value(name); }
    void set_value(std::string_view name, double value) override { bench_.set_value(name, value); }

  private:
    Bench &bench_;
};

struct Figures {
    double worst_scale = 0, worst_spread = 0, least_gain = 0, least_margin = 1e9, least_phase = 180;
    double time_s = 0;
};

class Session {
  public:
    Session(unsigned seed, std::filesystem::path folder, bool isTold)
        : truth_(make_true_machine(seed)), folder_(std::move(folder)), machine_folder_(folder_ / "machine"),
          told_(isTold), world_(truth_, folder_.string()),
          owner_(world_, seed, truth_.trouble == Trouble::ENCODER_SWAPPED) {}

    std::string run() {
        write();
        commission();
        if (failure_.empty() && truth_.trouble == Trouble::NONE) {
            judge_files();
        }
        if (failure_.empty() && truth_.trouble == Trouble::NONE) {
            judge_machine();
        }
        return fmt::format("board {} axes {} time {:.0f} scale {:.6f} spread {:.1f} better {:.2f} margin "
                           "{:.2f} phase {:.0f} {}",
                           static_cast<int>(truth_.board), truth_.axes.size(), figures_.time_s,
                           figures_.worst_scale, figures_.worst_spread, figures_.least_gain,
                           figures_.least_margin > 1e8 ? 0 : figures_.least_margin, figures_.least_phase,
                           failure_.empty() ? "ok" : "FAILED " + failure_);
    }

  private:
    void fail(const std::string &rule, const std::string &what) {
        if (failure_.empty()) {
            failure_ = rule + ": " + what;
        }
    }

    void write() {
        const auto planned = setup::plan_of(truth_.answers);
        if (!planned.faults.empty()) {
            return fail("answers", planned.faults[0].key + " " + planned.faults[0].text);
        }
        const auto made = programs::make_machine(machine_folder_.string(), planned.plan, truth_.answers);
        if (!made.has_value()) {
            fail("write", made.error().str());
        }
    }

    programs::CommissionSetup setup() {
        programs::CommissionSetup setup{.folder = machine_folder_.string(),
                                        .clock_virtual = true,
                                        .known = {},
                                        .isWanted = nullptr,
                                        .prepare = {},
                                        .on_start = {},
                                        .wrap = {}};
        setup.prepare = [this](const std::string &ini) { return world_.prepare(ini); };
        setup.on_start = [this](machine::Machine &machine) { world_.connect(machine); };
        if (!truth_.isRaised) {
            setup.isWanted = [](const commissioning::Step &step) { return step.name != "limits"; };
        }
        if (truth_.trouble == Trouble::LATE_THREAD) {
            setup.wrap = [](Bench &bench) { return std::make_unique<LateBench>(bench); };
        }
        return setup;
    }

    void commission() {
        if (!failure_.empty()) {
            return;
        }
        auto opened = programs::Commissioner::open(setup());
        if (!opened.has_value()) {
            return fail("open", opened.error().str());
        }
        programs::Commissioner &commissioner = **opened;
        commissioning::Guide &guide = commissioner.guide();
        constexpr double LONGEST_S = 4000;
        constexpr double CYCLE_S = 0.001;
        int shown = -1;
        while (!guide.isOver() && failure_.empty()) {
            figures_.time_s += CYCLE_S;
            if (figures_.time_s > LONGEST_S) {
                return fail("time", guide.steps()[guide.current()].title + ": " + guide.prompt().text);
            }
            if (told_ && shown != guide.prompt_number()) {
                shown = guide.prompt_number();
                fmt::print("{:8.2f} [{}] {}\n", figures_.time_s, guide.prompt().step, guide.prompt().text);
            }
            const auto act = owner_.look(guide.prompt_number(), guide.prompt(), figures_.time_s);
            if (act.has_value()) {
                static_cast<void>(guide.act(guide.prompt_number(), *act));
                if (told_ && act->type != commissioning::Act::Type::HOLD) {
                    fmt::print("         owner: {} {}\n", act->number, act->choice);
                }
            }
            if (auto done = commissioner.cycle(); !done.has_value()) {
                return fail("cycle", done.error().str());
            }
            std::vector<double> before;
            for (std::size_t i = 0; i < truth_.axes.size(); ++i) {
                before.push_back(world_.table(i));
            }
            world_.step();
            if (!world_.damage().empty()) {
                return fail("damage", world_.damage() + " in " + guide.prompt().text);
            }
            const bool is_held = act.has_value() && act->type == commissioning::Act::Type::HOLD;
            held_s_ = is_held ? figures_.time_s : held_s_;
            judge_motion(before, guide.prompt().text);
        }
        judge_findings(guide);
    }

    /// Only one drive is on, and only while the owner holds the button, plus the time to stop.
    void judge_motion(const std::vector<double> &before, const std::string &text) {
        constexpr double STOPPING_S = 1.0, MOVED_MM = 0.005;
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (std::abs(world_.table(i) - before[i]) > MOVED_MM && figures_.time_s > held_s_ + STOPPING_S) {
                fail("held", fmt::format("{} moves without the button in {}", truth_.axes[i].letter, text));
            }
        }
        // Pins are read only at intervals, because reading takes time.
        if (++cycles_ % 10 == 0 && world_.count_enabled() > 1) {
            fail("alone", "more than one drive is enabled in " + text);
        }
    }

    void judge_findings(const commissioning::Guide &guide) {
        const auto &last = guide.findings()[std::min(guide.current(), guide.findings().size() - 1)];
        const std::string fault = last.has_value() ? std::string(commissioning::fault_name(last->fault)) : "";
        const std::string where =
            last.has_value() ? last->step + " " + last->motor + ": " + fault + " " + last->detail : "";
        for (const auto &finding : guide.findings()) {
            for (const auto &value :
                 finding.has_value() ? finding->values : std::vector<commissioning::Value>{}) {
                if (told_) {
                    fmt::print("{} {} {} = {} {}\n", finding->step, finding->motor, value.name, value.number,
                               value.unit);
                }
            }
            if (finding.has_value() && finding->step == "tune" && finding->values.size() > 1) {
                const double better = finding->values[0].number / finding->values[1].number;
                figures_.least_gain =
                    figures_.least_gain == 0 ? better : std::min(figures_.least_gain, better);
            }
        }
        if (truth_.trouble == Trouble::NONE) {
            if (truth_.isRaised ? !guide.isReady()
                                : guide.isFaulted() || guide.current() < guide.steps().size()) {
                fail("ready", where);
            }
            return;
        }
        if (guide.isReady()) {
            fail("trouble", fmt::format("ready with '{}'", trouble_name(truth_.trouble)));
        } else if (fault != trouble_name(truth_.trouble)) {
            fail("name", fmt::format("'{}' is named '{}'", trouble_name(truth_.trouble), where));
        }
    }

    static double number(const ini::IniFile &ini, const std::string &section, const char *key) {
        const ini::IniEntry *const entry = ini.find(section, key);
        return entry == nullptr ? 0 : std::stod(entry->value);
    }

    void judge_files() {
        diagnostics::Sink sink;
        const auto ini = ini::IniFile::load((machine_folder_ / "machine.ini").string(), sink);
        if (!ini.has_value()) {
            return fail("files", "no INI file");
        }
        for (std::size_t i = 0; i < truth_.axes.size(); ++i) {
            const TrueAxis &axis = truth_.axes[i];
            const std::string section = fmt::format("JOINT_{}", i);
            const bool servo = truth_.board == Board::MESA_SERVO;
            const double wanted = (servo ? axis.counts_per_rev : axis.steps_per_rev) / axis.travel_per_rev;
            const double scale = number(*ini, section, servo ? "ENCODER_SCALE" : "STEP_SCALE");
            const double off = std::abs(scale / wanted - 1);
            figures_.worst_scale = std::max(figures_.worst_scale, off);
            if (!(off < 0.001)) {
                fail("scale", fmt::format("{}: {} instead of {}", axis.letter, scale, wanted));
            }
            if (servo) {
                judge_loop(axis, number(*ini, section, "P"), number(*ini, section, "OUTPUT_SCALE"));
            }
        }
    }

    /// Gain and phase margin of the loop with the true drive: P / s, lag of the drive, and the delay of two
    /// periods.
    void judge_loop(const TrueAxis &axis, double p, double output_scale) {
        const double drive = axis.full_rev_s * axis.travel_per_rev / output_scale;
        constexpr double DELAY_S = 0.0015;
        if (drive <= 0) {
            return fail("loop", fmt::format("{}: the speed command has the wrong sign", axis.letter));
        }
        const auto loop = [&](double w) {
            const std::complex<double> s(0, w);
            return p * drive / s / (1.0 + s * axis.lag_s) * std::exp(-s * DELAY_S);
        };
        double gain_margin = 1e9, phase_margin = 180, last = -90;
        for (double w = 1; w < 3000; w *= 1.002) {
            const std::complex<double> value = loop(w);
            const double phase = -90 - std::atan(w * axis.lag_s) * 180 / std::numbers::pi -
                                 w * DELAY_S * 180 / std::numbers::pi;
            if (last > -180 && phase <= -180) {
                gain_margin = std::min(gain_margin, 1 / std::abs(value));
            }
            if (std::abs(value) >= 1) {
                phase_margin = std::min(phase_margin, 180 + phase);
            }
            last = phase;
        }
        figures_.least_margin = std::min(figures_.least_margin, gain_margin);
        figures_.least_phase = std::min(figures_.least_phase, phase_margin);
        if (gain_margin < 2 || phase_margin < 30) {
            fail("loop", fmt::format("{}: gain margin {:.2f}, phase margin {:.0f}", axis.letter, gain_margin,
                                     phase_margin));
        }
    }

    /// A machine whose simulated environment advances with each cycle.
    class WatchedMachine final : public programs::MachineAccess {
      public:
        WatchedMachine(machine::Machine &machine, World &world) : machine_(machine), world_(world) {}
        void cycle() override {
            machine_.cycle();
            world_.step();
        }
        std::int64_t now_ns() const override { return machine_.now_ns(); }
        Result<> health() const override { return machine_.health(); }
        client::Client &client() override { return machine_.client(); }
        bool isShared() const override { return false; }

      private:
        machine::Machine &machine_;
        World &world_;
    };

    /// The machine of the final files, with the true hardware and the ordinary controller: homes and moves.
    void judge_machine() {
        const auto ini = world_.prepare((machine_folder_ / "machine.ini").string());
        diagnostics::Sink sink;
        const auto loaded = ini.has_value() ? machine::LoadedConfig::load(*ini, sink) : nullptr;
        if (loaded == nullptr) {
            return fail("start", "the files cannot be read");
        }
        machine::MachineOptions options;
        options.isLasting = true;
        auto made =
            machine::make_virtual_machine({loaded->ini, loaded->reader, loaded->machine, sink}, options);
        if (!made.has_value()) {
            return fail("start", made.error().str());
        }
        world_.connect(**made);
        WatchedMachine watched(**made, world_);
        programs::RunSession person(watched, loaded->machine, sink, {});
        std::vector<double> homes;
        for (int time = 0; time < 3; ++time) {
            auto done = person.switch_on();
            done = done.has_value() ? person.home_all() : done;
            if (!done.has_value()) {
                return fail("home", done.error().str());
            }
            for (int cycle = 0; cycle < 500; ++cycle) {
                watched.cycle();
            }
            compare_homes(homes);
            if (time < 2) {
                static_cast<void>(watched.client().post(messages::UnhomeJoint{-1}));
                for (int cycle = 0; cycle < 50; ++cycle) {
                    watched.cycle();
                }
            }
        }
        drive(watched, *loaded);
        if (!world_.damage().empty()) {
            fail("damage", world_.damage());
        }
    }

    /// Each axis at full speed through its travel, and back.
    void drive(WatchedMachine &machine, const machine::LoadedConfig &loaded) {
        static_cast<void>(machine.client().post(messages::SetMode{messages::Mode::MDI}));
        for (const char *key : {"MAX_LIMIT", "MIN_LIMIT", "MAX_LIMIT"}) {
            std::string line = "G53 G0";
            std::vector<double> wanted;
            for (std::size_t i = 0; i < truth_.axes.size(); ++i) {
                const double inside = key[1] == 'A' ? -1 : 1;
                wanted.push_back(number(loaded.ini, fmt::format("AXIS_{}", truth_.axes[i].letter), key) +
                                 inside);
                line += fmt::format(" {}{:.4f}", truth_.axes[i].letter, wanted.back());
            }
            std::vector<double> before;
            for (std::size_t i = 0; i < truth_.axes.size(); ++i) {
                before.push_back(world_.table(i) - machine.client().status().joints[i].pos_cmd);
            }
            const auto posted = machine.client().post(messages::Mdi{line});
            constexpr int LONGEST = 60000;
            for (int cycle = 0; cycle < LONGEST; ++cycle) {
                machine.cycle();
                static_cast<void>(machine.client().read_status());
                if (posted.has_value() &&
                    machine.client().outcome(*posted).progress != messages::Progress::STARTED) {
                    break;
                }
            }
            for (int cycle = 0; cycle < 300; ++cycle) {
                machine.cycle();
            }
            static_cast<void>(machine.client().read_status());
            for (std::size_t i = 0; i < truth_.axes.size(); ++i) {
                const double command = machine.client().status().joints[i].pos_cmd;
                if (std::abs(command - wanted[i]) > 0.001) {
                    return fail("drive", fmt::format("{} is at {} instead of {}", truth_.axes[i].letter,
                                                     command, wanted[i]));
                }
                // Within 0.1 % of the travel, and the backlash.
                const double off = std::abs(world_.table(i) - command - before[i]);
                const double allowed = 0.001 * 400 + truth_.axes[i].backlash;
                if (off > allowed) {
                    fail("drive",
                         fmt::format("the table of {} is off by {:.3f}", truth_.axes[i].letter, off));
                }
            }
        }
        if (world_.hasSlipped()) {
            fail("stall", "steps are lost at the tuned limits");
        }
    }

    /// The table returns to the same count each time.
    void compare_homes(std::vector<double> &homes) {
        for (std::size_t i = 0; i < truth_.axes.size(); ++i) {
            const TrueAxis &axis = truth_.axes[i];
            const double per_rev =
                truth_.board == Board::MESA_SERVO ? axis.counts_per_rev : axis.steps_per_rev;
            const double counts = world_.table(i) / axis.travel_per_rev * per_rev;
            if (homes.size() <= i) {
                homes.push_back(counts);
                continue;
            }
            const double spread = std::abs(counts - homes[i]);
            figures_.worst_spread = std::max(figures_.worst_spread, spread);
            if (spread > 1.01) {
                fail("homing", fmt::format("{}: {:.2f} counts apart", axis.letter, spread));
            }
        }
    }

    TrueMachine truth_;
    std::filesystem::path folder_, machine_folder_;
    bool told_;
    World world_;
    Owner owner_;
    Figures figures_;
    double held_s_ = -10;
    unsigned cycles_ = 0;
    std::string failure_;
};

}  // namespace

std::string run_session(unsigned seed, const std::filesystem::path &folder, bool isTold) {
    std::filesystem::create_directories(folder);
    return Session(seed, folder, isTold).run();
}

}  // namespace mw::commissioning_campaign
