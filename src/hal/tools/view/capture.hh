// SPDX-License-Identifier: GPL-2.0-or-later
// Records of pins, signals and parameters made by the realtime module `capture`. [one thread]
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/core/host.hh"
#include "hal/tools/view/capture_block.hh"

namespace mw::hal::view {

struct CaptureRequest {
    std::vector<std::string> names;  ///< pins, signals or parameters, 1 to CAPTURE_CHANNELS
    std::uint32_t samples = 1000;
    std::uint32_t every = 1;  ///< record each N-th period
    TriggerKind trigger = TriggerKind::NONE;
    /// Of a pin, signal or parameter; becomes a channel when it is none of `names`.
    std::string trigger_name = {};
    double level = 0.5;
    double pretrigger = 0.0;  ///< part of the record before the trigger, 0 to below 1
};

struct CaptureRecord {
    std::vector<std::string> names;
    std::vector<Type> types;
    std::vector<double> times_s;               ///< of each sample, the trigger's is 0
    std::vector<std::vector<double>> columns;  ///< for each name a value per sample
    /// Names whose links changed while it was recorded: their values are of the old place from then on.
    std::vector<std::string> moved;
};

/// The module's memory, used by one program at a time.
class Capture {
  public:
    /// Loads the module unless it is loaded, and appends capture.sample to `thread` unless a thread has it;
    /// an empty name means the only thread, or servo-thread. An error when another live program uses it.
    static Result<Capture> open(Host &host, const std::string &thread);
    Capture(Capture &&other) noexcept;
    Capture &operator=(Capture &&) = delete;
    /// Cancels what is going on, takes the function out of the thread again if it was put there.
    ~Capture();

    /// Begins a record; the next cycle takes it up.
    Result<> begin(const CaptureRequest &request);
    /// Of the last record begun; FILLING before the next cycle has seen it.
    CaptureState state() const noexcept;
    /// Triggers it now.
    void force() noexcept;
    void cancel() noexcept;
    /// The record, when the state is DONE.
    Result<CaptureRecord> record() const;

  private:
    Capture(Hal &hal, CaptureBlock &block) : hal_(&hal), block_(&block) {}
    Result<CaptureChannel> channel_of(const std::string &name) const;

    Hal *hal_;
    CaptureBlock *block_;
    std::string added_to_;  ///< thread that capture.sample was put in
    std::vector<std::string> names_;
    CaptureSettings settings_{};
    std::uint32_t request_ = 0;
};

/// The record as CSV: a header of names, then time [s] and values, in as many digits as needed.
std::string to_csv(const CaptureRecord &record);
/// The record as .csv, .png or .svg, by the ending of `path`.
Result<> write_record(const CaptureRecord &record, const std::string &title, const std::string &path);

}  // namespace mw::hal::view
