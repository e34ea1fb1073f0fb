// SPDX-License-Identifier: GPL-2.0-or-later
// The certificate of motion: to which extent the commanded positions of a program used the limits of the
// machine, and their distance from the programmed path. It is calculated from the moves sent to motion, the
// samples of the servo thread and the limits in the INI file. No result of the planner is used.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "machine/certificate/limit_use.hh"
#include "machine/certificate/path_deviation.hh"
#include "machine/config/machine_config.hh"
#include "machine/task/sequencer/sequencer.hh"
#include "motion/interface/channels.hh"

namespace mw::machine {

struct CertificateSettings {
    std::vector<LimitedCoordinate> coordinates;
    double period_s = 0.001;
};

/// Axes, joints that a pose moves, and the norm over X, Y and Z, with the limits of the INI file. Jerk limits
/// only if motion applies them ([TRAJ]PLANNER_TYPE).
CertificateSettings certificate_settings(const MachineConfig &machine);

/// The file of the last program's certificate, beside the parameter file; empty if there is no parameter
/// file.
std::string last_certificate_file(const MachineConfig &machine);

struct Certificate {
    std::vector<CoordinateUse> uses;
    Deviations deviations;
    std::uint64_t samples = 0;       ///< number of samples of program motion
    std::uint64_t lost_samples = 0;  ///< servo cycles that are missing from the samples; the figures are then
                                     ///< incomplete

    bool isWithinLimits() const;
    bool isWithinTolerance() const;
};

enum class ProgramEnd : std::uint8_t {
    COMPLETE,  ///< the program ran to its end
    STOPPED,   ///< the rest of the path was not executed
};

/// The certificate of one program. One thread: samples of the servo thread arrive through the trace ring
/// (motion::Channels).
class MotionCertificate {
  public:
    explicit MotionCertificate(const CertificateSettings &settings);

    /// Called in the order of the program, for each move before its first sample.
    void on_move(const task::SentMove &move);
    void on_sample(const motion::TraceSample &sample);
    void finish(ProgramEnd end);

    Certificate result() const;
    /// True if the move at the last sample is a rapid.
    bool isRapid() const { return path_.isRapid(); }

  private:
    /// Positions of a sample whose position on the path is known only with the next sample.
    struct HeldUse {
        LimitUse::Sample sample;
        bool isMeasured = false, isRestart = false;
    };

    /// Counts lost cycles; false if the positions do not continue those of the last sample.
    bool isContinuous(const motion::TraceSample &sample);
    void take_held();

    CertificateSettings settings_;
    LimitUse limits_;
    PathDeviation path_;
    std::uint64_t samples_ = 0, lost_ = 0;
    std::int64_t start_ns_ = 0;
    std::uint64_t last_cycle_ = 0;
    std::uint8_t pose_kind_ = 0;
    bool isFirst_ = true;
    bool isProgram_ = false;  ///< the last sample belongs to program motion
    std::optional<HeldUse> held_;
    int settling_ = 0;  ///< number of samples after program motion whose differences still contain it
};

}  // namespace mw::machine
