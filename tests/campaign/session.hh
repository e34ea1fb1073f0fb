// SPDX-License-Identifier: GPL-2.0-or-later
// Runs a plan: the acts of the operator, the faults at their times, and the judge at every sample.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>

#include "campaign/judge.hh"
#include "campaign/plan.hh"
#include "campaign/rig.hh"

namespace mw::campaign {

/// Counts of an optional feature of a session.
struct Extension {
    int ran = 0, judged = 0;
};

struct Verdict {
    std::string fault;  ///< "rule: text"; empty: no violation
    double seconds = 0;
    int stops = 0;  ///< aborts, exits and faults
    int programs = 0, ended = 0, timed = 0;
    int commands = 0, refused = 0;
    std::map<std::string, int> known;     ///< violations of known rules
    std::map<std::string, int> refusals;  ///< by reason, figures replaced
    /// Counts by optional feature, and stops by cause (`judged`: stops during a motion).
    std::map<std::string, Extension> extensions;
    double slowest_stop = 0, worst_time = 0;
    std::uint64_t hash = 0;  ///< of all commanded positions
};

/// Maximum time until a jog, or an external offset that has just started, stops.
inline constexpr double LONGEST_CALM_S = 10;

struct Telling {
    std::FILE *stream = nullptr;  ///< output of the events
    std::string trace;            ///< file of the commanded positions; empty: none
    std::set<std::string> known;  ///< rules with known violations
};

/// Runs in a separate folder, which contains the files of the machine.
class Session {
  public:
    Session(const Plan &plan, std::filesystem::path folder, const Telling &telling);
    Verdict run();

  private:
    enum class End { DONE, REFUSED, FAILED, LATE };

    void cycle();
    void fail(const std::string &rule, const std::string &text);
    bool isOver() const { return !verdict_.fault.empty() || isTaskGone_; }
    client::Serial post(const messages::Command &command);
    End wait(client::Serial command, double most_s);
    End ask(const messages::Command &command, double most_s = 5);
    void settle(double most_s);
    messages::State state();

    bool prepare();
    void await_slides();
    bool switch_on();
    bool home();
    bool clear_offsets();
    bool set_mode(messages::Mode mode);

    void perform(const Act &act);
    void run_program(const Act &act);
    void jog(const Act &act);
    void keep_lease(const Act &act);
    void turn(const Act &act);
    bool begin_manual(bool isJoint);
    double place_of(const Act &act, bool isJoint) const;
    bool areSidesApart() const;
    std::pair<double, double> range_of(const Act &act, bool isJoint) const;
    void begin_troubles(const Act &act);
    void step_troubles();
    void begin(const Trouble &t);
    void begin_offset(const Trouble &t);
    void begin_stop(const Trouble &t);
    void end(const Trouble &t);
    void check_program(const Act &act, const geometry::Pose &from, double took_s);
    void check_sync(const Act &act, End end);
    void check_helix(const SyncWish &sync);
    void check_per_turn(const SyncWish &sync);
    void check_surface(const SyncWish &sync);
    bool isProbeMoved(const Act &act) const;
    void check_probing(const Act &act, End end);
    double estimate(const Act &act, const geometry::Pose &from) const;

    const Plan &plan_;
    std::filesystem::path folder_;
    std::FILE *tell_;
    std::ofstream trace_;
    std::unique_ptr<Rig> rig_;
    Judge judge_;
    Verdict verdict_;
    bool isTaskGone_ = false;
    bool areEncodersTrue_ = true;
    // --- of the current act
    const Act *act_ = nullptr;
    std::uint64_t began_ = 0;
    std::size_t next_trouble_ = 0;
    struct Going {
        Trouble trouble;
        std::uint64_t until = 0;
    };
    std::vector<Going> going_;
    std::uint64_t commanded_ = 0;  ///< cycle of the last commands of any kind
    bool isStopped_ = false, isDisturbed_ = false, isReversed_ = false;
    bool isRecording_ = false;
    std::vector<geometry::Pose> path_;
    std::vector<JointSample> led_;     ///< joints at the end of path_
    double led_s_ = 0;                 ///< time in which joints aligned with the axes before the first move
    std::vector<double> turns_, rpm_;  ///< of the spindle, with path_
    std::vector<std::string> told_;    ///< messages of the program
    std::map<int, double> beyond_walls_;  ///< maximum travel of the probe past its walls, by axis
};

}  // namespace mw::campaign
