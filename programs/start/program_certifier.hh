// SPDX-License-Identifier: GPL-2.0-or-later
// Certificates of motion of the programs that run on a lasting machine (docs/user/certificate.md).
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "machine/assembly/machine.hh"
#include "machine/certificate/motion_certificate.hh"
#include "programs/run/certificate_report.hh"

namespace mw::programs {

/// Task's thread only passes on moves and the start and end of programs. A thread of this class reads the
/// samples of the servo thread and calculates. Task's thread passes the result to the journal's writer,
/// because a disk that does not answer must not prevent the machine from ending. During its lifetime it is
/// the only listener of the machine's moves and the only reader of its samples.
class ProgramCertifier {
  public:
    ProgramCertifier(machine::Machine &machine, const machine::MachineConfig &config);
    ~ProgramCertifier();
    ProgramCertifier(const ProgramCertifier &) = delete;
    ProgramCertifier &operator=(const ProgramCertifier &) = delete;

    /// Once a task cycle. [task's thread]
    void step();

    /// Information for the operator about a program that has ended.
    struct Finding {
        std::string text;
        bool isFault = false;  ///< a limit or a tolerance was exceeded
        std::string json;      ///< the certificate for the file; empty: already passed on
    };
    /// The next finding; empty if there is none. [task's thread]
    std::optional<Finding> take_finding();

  private:
    struct Begin {
        std::string program;
    };
    struct Move {
        motion::CommandId id = 0;
        geometry::Pose start;
        motion::PathBody body;
    };
    struct FileName {
        std::uint32_t index = 0;
        std::string name;
    };
    struct End {
        machine::ProgramEnd how = machine::ProgramEnd::STOPPED;
        double cycle_time_s = 0;
    };
    using Event = std::variant<Begin, Move, FileName, End>;
    /// The program that is certified.
    struct Program {
        std::string name;
        machine::MotionCertificate certificate;
    };

    void push(Event event);
    void pass_moves();
    void pass_file_name(const motion::PathBody &body);
    void run(const std::stop_token &stop);
    void take(Event &event);
    void read_samples();
    void take_samples();
    void finish(const End &end);
    void add(Finding finding);

    machine::Machine &machine_;
    const machine::MachineConfig &config_;
    const std::string file_;
    // --- used by task's thread
    bool isRunning_ = false;
    std::int64_t start_ns_ = 0;
    std::vector<Move> sent_;  ///< moves sent in this cycle
    std::vector<std::uint32_t> passed_files_;
    // --- used by the certifier's thread
    std::optional<Program> program_;
    std::map<std::uint32_t, std::string> files_;
    std::vector<motion::TraceSample> samples_;  ///< samples read and not processed
    // --- used by both
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::deque<Event> events_;
    std::deque<Finding> findings_;
    std::jthread thread_;  ///< last member, because it uses the others
};

}  // namespace mw::programs
