// SPDX-License-Identifier: GPL-2.0-or-later
// The state of a smart serial port. It starts the exchange with its cards, requests one exchange in each
// cycle, counts faults, and restarts after too many faults. Functions without access to registers. Source:
// shared/hardware.md, parts B9 and G.
#pragma once

#include <cstdint>

#include "drivers/mesa/hostmot2/pins.hh"

namespace mw::mesa {

/// Values of the pin port_state.
enum class SserialState : std::uint32_t {
    IDLE = 0,      ///< `run` is false, or nothing has been written yet
    STARTING = 2,  ///< the cards are started
    RUNNING = 3,
    STOPPING = 4,  ///< stopped after faults, with a pause in which the cards turn their outputs off
    SETUP = 7,     ///< parameters are written to the cards
    FAULTED = 10,  ///< the last attempt to start has failed; the next one follows
};

struct SserialPortPins {
    bool run = true;
    bool fault = false;  ///< stopped after faults: inputs are old and outputs are off
    std::uint32_t fault_count = 0, port_state = 0, port_state2 = 0, port_state3 = 0;
    std::uint32_t fault_inc = 10, fault_dec = 1, fault_lim = 200;
};
constexpr PinRow<SserialPortPins> SSERIAL_PORT_PINS[] = {
    {"run", Access::IN, &SserialPortPins::run},
    {"fault", Access::OUT, &SserialPortPins::fault},
    {"fault-count", Access::OUT, &SserialPortPins::fault_count},
    {"port_state", Access::OUT, &SserialPortPins::port_state},
    {"port_state2", Access::OUT, &SserialPortPins::port_state2},
    {"port_state3", Access::OUT, &SserialPortPins::port_state3},
    {"fault-inc", Access::RW, &SserialPortPins::fault_inc},
    {"fault-dec", Access::RW, &SserialPortPins::fault_dec},
    {"fault-lim", Access::RW, &SserialPortPins::fault_lim},
};

/// Values read from the registers of a port.
struct SserialReading {
    std::uint32_t command = 0;  ///< 0: the last command is done
    std::uint32_t failed = 0;   ///< bits of channels of the data register
    std::uint32_t faulty = 0;   ///< channels whose status has a fault
    std::int64_t now_ns = 0;    ///< time of this read
    double period_s = 0.001;
};

/// Events of a port, with one message for each burst.
struct SserialEvents {
    enum class Type : std::uint8_t {
        NONE,
        LATE,       ///< an exchange is longer than the period
        FAULT,      ///< too many faults: stopped
        NO_START,   ///< the cards do not start
        NO_SETUP,   ///< parameters could not be written
        RECOVERED,  ///< the port runs again
    } type = Type::NONE;
    std::uint32_t channels = 0;                    ///< channels that failed
    std::int64_t shortest_ns = 0, longest_ns = 0;  ///< minimum and maximum time of an exchange; 0: not known
    std::int64_t stopped_ns = 0;                   ///< duration of the stop
    std::int64_t period_ns = 0;
};

/// Registers that a port writes in this cycle.
struct SserialCommand {
    bool isDue = false;
    std::uint32_t command = 0;
    bool is_setup_step = false;  ///< the cards are in set-up: setup_step() or finish_setup() must follow
    bool has_modes = false;      ///< contains the modes of the cards
    bool has_data = false;       ///< contains the outputs of the cards
};

/// State of the outputs with the next command.
enum class SserialOutputs : std::uint8_t { KEPT, HELD, RELEASED };

class SserialPortControl {
  public:
    explicit SserialPortControl(std::uint32_t channels) noexcept : channels_(channels) {}

    /// Processes a new read; returns the mask of channels with new words. [servo thread]
    std::uint32_t read(SserialPortPins &pins, const SserialReading &reading) noexcept;
    /// Selects the command of this cycle. `writing` false: nothing can be sent. [servo thread]
    struct Moment {
        std::int64_t now_ns = 0;
        double period_s = 0.001;
        bool writing = false;
        bool has_parameters = false;  ///< parameters differ from those of the cards
    };
    SserialCommand write(SserialPortPins &pins, const Moment &moment) noexcept;
    /// One exchange in set-up with a channel. [servo thread]
    SserialCommand setup_step(int channel) noexcept;
    /// Called when all parameters are written, or one of the `failed` channels could not be written. [servo
    /// thread]
    void finish_setup(SserialPortPins &pins, std::uint32_t failed) noexcept;
    /// Called when the start of the set-up may have been lost. [servo thread]
    void repeat_setup(SserialPortPins &pins) noexcept { enter(pins, SserialState::IDLE); }
    /// Events since the last call; returned once. [servo thread]
    SserialEvents take_event() noexcept;
    SserialOutputs take_outputs() noexcept;

  private:
    void note_late(SserialPortPins &pins, const SserialReading &reading) noexcept;
    void note_in_time(const SserialReading &reading) noexcept;
    void note_fault(SserialPortPins &pins, std::uint32_t channels) noexcept;
    void stop_by_faults(SserialPortPins &pins, SserialEvents::Type type, std::uint32_t channels) noexcept;
    void enter(SserialPortPins &pins, SserialState state) noexcept;
    SserialCommand send(std::uint32_t command) noexcept;
    SserialCommand start(SserialPortPins &pins) noexcept;
    SserialCommand write_idle(SserialPortPins &pins, const Moment &moment) noexcept;
    SserialCommand write_setup(SserialPortPins &pins, double period_s) noexcept;
    SserialCommand write_stopping(SserialPortPins &pins, double period_s) noexcept;
    void evaluate_start(SserialPortPins &pins, const SserialReading &reading) noexcept;

    std::uint32_t channels_;
    SserialState state_ = SserialState::IDLE;
    double in_state_s_ = 0.0, gap_s_ = 0.0, stopped_s_ = 0.0, quiet_s_ = 0.0;
    std::uint32_t last_command_ = 0;
    bool clear_ = false;    ///< in the last read no command was active
    bool answered_ = true;  ///< the last command has been evaluated
    bool stop_sent_ = false, setup_done_ = false, recovering_ = false, late_reported_ = false;
    int exchanges_ = 0;  ///< number since the start of the cards, up to a few
    int silent_starts_ = 0;
    int late_streak_ = 0;  ///< number of consecutive exchanges that were active during a read
    int late_reads_ = 0;   ///< number of reads during this exchange
    std::int64_t sent_ns_ = 0, late_shortest_ns_ = 0;
    SserialEvents event_;
    SserialOutputs outputs_ = SserialOutputs::KEPT;
};

}  // namespace mw::mesa
