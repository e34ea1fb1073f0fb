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
    std::uint32_t every = 1;  ///< record every N-th period
    TriggerKind trigger = TriggerKind::NONE;
    /// A pin, signal or parameter; an additional channel if it is not in `names`.
    std::string trigger_name = {};
    double level = 0.5;
    double pretrigger = 0.0;  ///< fraction of the record before the trigger, 0 to below 1
};

struct CaptureRecord {
    std::vector<std::string> names;
    std::vector<Type> types;
    std::vector<double> times_s;               ///< of each sample; 0 at the trigger
    std::vector<std::vector<double>> columns;  ///< one value per sample for each name
    /// Names whose links changed during the record. Their later values are read from the old address.
    std::vector<std::string> moved;
};

/// The memory of the module, used by one program at a time.
class Capture {
  public:
    /// Loads the module unless it is loaded, and appends capture.sample to `thread` unless a thread has it;
    /// an empty name means the only thread, or servo-thread. An error when another running program uses it.
    static Result<Capture> open(Host &host, const std::string &thread);
    Capture(Capture &&other) noexcept;
    Capture &operator=(Capture &&) = delete;
    /// Cancels the record, and removes the function from the thread if it was added here.
    ~Capture();

    /// Begins a record, which starts with the next cycle.
    Result<> begin(const CaptureRequest &request);
    /// State of the last record; FILLING until the next cycle.
    CaptureState state() const noexcept;
    /// Triggers the record now.
    void force() noexcept;
    void cancel() noexcept;
    /// The record, when the state is DONE.
    Result<CaptureRecord> record() const;

  private:
    Capture(Instance &hal, CaptureBlock &block) : hal_(&hal), block_(&block) {}
    Result<CaptureChannel> channel_of(const std::string &name) const;

    Instance *hal_;
    CaptureBlock *block_;
    std::string added_to_;  ///< thread to which capture.sample was added
    std::vector<std::string> names_;
    CaptureSettings settings_{};
    std::uint32_t request_ = 0;
};

/// The record as CSV: a header of names, then time [s] and values, with the necessary digits.
std::string to_csv(const CaptureRecord &record);
/// Writes the record as .csv, .png or .svg, by the extension of `path`.
Result<> write_record(const CaptureRecord &record, const std::string &title, const std::string &path);

}  // namespace mw::hal::view
