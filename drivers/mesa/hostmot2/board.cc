// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/board.hh"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "drivers/mesa/hostmot2/modules/factories.hh"
#include "drivers/mesa/hostmot2/modules/ioport.hh"
#include "drivers/mesa/hostmot2/modules/sserial_discovery.hh"

namespace mw::mesa {

namespace {

constexpr double S_PER_NS = 1e-9;

Cycle cycle_of(long period_ns) noexcept {
    Cycle cycle;
    cycle.period_s = static_cast<double>(std::max(period_ns, 1L)) * S_PER_NS;
    return cycle;
}

}  // namespace

Result<std::unique_ptr<Board>> Board::make(RegisterBus &bus, const Idrom &idrom, const Config &config) {
    auto assignment = assign(idrom, config, bus.leds());
    if (!assignment) {
        return std::unexpected(assignment.error());
    }
    if (auto found = discover_sserial(bus, idrom, config, *assignment); !found) {
        return std::unexpected(found.error());
    }
    std::unique_ptr<Board> board(new Board(bus, std::move(*assignment)));
    for (const UsedModule &module : board->assignment_.modules) {
        board->add(idrom, config, module);
    }
    if (config.raw_enabled) {
        board->modules_.push_back(make_raw());
    }
    for (const auto &module : board->modules_) {
        if (auto prepared = module->prepare(bus); !prepared) {
            return std::unexpected(prepared.error());
        }
        module->plan(board->registers_);
    }
    if (auto fixed = board->registers_.fix(bus); !fixed) {
        return std::unexpected(fixed.error());
    }
    return board;
}

void Board::add(const Idrom &idrom, const Config &config, const UsedModule &module) {
    if (module.instances == 0) {
        return;
    }
    switch (module.descriptor.gtag) {
    case Gtag::IO_PORT: {
        auto ports =
            std::make_unique<IoPorts>(module, assignment_, static_cast<int>(idrom.header.port_width));
        ports_ = ports.get();
        modules_.push_back(std::move(ports));
        return;
    }
    case Gtag::WATCHDOG: {
        auto watchdog = std::make_unique<Watchdog>(module);
        watchdog_ = watchdog.get();
        modules_.push_back(std::move(watchdog));
        return;
    }
    default: break;
    }
    if (auto made = make_module({module, assignment_, config, idrom})) {
        modules_.push_back(std::move(made));
    }
}

void Board::declare(PinSpace &space) {
    for (const auto &module : modules_) {
        module->declare(space);
    }
}

bool Board::hasTriggers() const noexcept {
    return std::ranges::any_of(modules_, [](const auto &module) { return module->hasTrigger(); });
}

void Board::trigger_encoders() noexcept {
    for (const auto &module : modules_) {
        module->trigger();
    }
}

Ports Board::ports() {
    Ports all;
    for (const auto &module : modules_) {
        module->add_ports(all);
    }
    return all;
}

// Finds out whether positions are lost. They are valid only while the driver follows the counters of the
// board in every cycle.
PositionLoss Board::find_loss(CycleRead result, bool bitten, bool restarted) noexcept {
    if (result == CycleRead::FAILED) {
        return PositionLoss::NONE;  // too few failures for a fault, so the next answer continues
    }
    const bool followed = std::exchange(followed_, result == CycleRead::DONE);
    const bool stopped = std::exchange(was_stopped_, was_stopped_ || result == CycleRead::STOPPED);
    const bool is_counting = std::ranges::any_of(modules_, [](const auto &one) { return one->isCounting(); });
    if (result == CycleRead::STOPPED) {
        return followed && is_counting ? PositionLoss::STOPPED : PositionLoss::NONE;
    }
    was_stopped_ = false;
    if (is_counting && restarted) {
        return PositionLoss::RESTARTED;
    }
    if (is_counting && stopped) {
        return PositionLoss::RETURNED;
    }
    const bool is_moving =
        std::ranges::any_of(modules_, [](const auto &one) { return one->isMovingUnmeasured(); });
    if (followed && bitten && is_moving) {
        return PositionLoss::BITTEN;
    }
    return followed && bitten && is_counting && !bus_.isRestartVisible() ? PositionLoss::RESTARTED
                                                                         : PositionLoss::NONE;
}

void Board::read(long period_ns, std::int64_t now_ns) noexcept {
    const CycleRead result = bus_.read(registers_.inputs(), period_ns);
    restarted_ = bus_.take_restart() || restarted_;
    fresh_ = result == CycleRead::DONE;
    stopped_ = result == CycleRead::STOPPED;
    // The watchdog may have bitten after a stop, so nothing is written before its status has been read again.
    is_read_once_ = fresh_ || (is_read_once_ && !stopped_);
    rewrite_due_ = bus_.take_rewrite() || rewrite_due_;
    write_doubtful_ = write_doubtful_ || rewrite_due_ || !fresh_;
    if (!fresh_) {
        loss_ = find_loss(result, false, false);
        ++failed_reads_;
        return;
    }
    const bool restarted = std::exchange(restarted_, false);
    if (restarted) {
        for (const auto &module : modules_) {
            module->restart();
        }
    }
    Cycle cycle = cycle_of(period_ns);
    cycle.fresh = true;
    cycle.has_lost_write = write_doubtful_;
    write_doubtful_ = false;
    read_ns_ = now_ns;
    cycle.now_ns = read_ns_;
    for (const auto &module : modules_) {
        module->read(registers_, cycle);
    }
    const bool bitten = watchdog_ != nullptr && watchdog_->take_bite();
    loss_ = find_loss(result, bitten, restarted);
    if (bitten) {
        bus_.note_watchdog_bite();
        events_.bitten = true;
        events_.longest_gap_ns = longest_gap_ns_;
        events_.failed_reads = failed_reads_;
        longest_gap_ns_ = 0;
    }
    failed_reads_ = 0;
}

void Board::write(long period_ns, std::int64_t now_ns) noexcept {
    Cycle cycle = cycle_of(period_ns);
    cycle.fresh = fresh_;
    cycle.now_ns = now_ns;
    const bool bitten = watchdog_ != nullptr && watchdog_->isBitten();
    cycle.writing = is_read_once_ && !stopped_ && !bitten;
    for (const auto &module : modules_) {
        module->write(registers_, cycle);
    }
    for (const auto &module : modules_) {
        events_.dump_requested = module->take_dump_request() || events_.dump_requested;
    }
    rewrite_due_ = bus_.take_rewrite() || rewrite_due_;
    if (watchdog_ != nullptr) {
        rewrite_due_ = rewrite_due_ || watchdog_->isRewriteWanted();
        cycle.writing = cycle.writing && !watchdog_->isBitten();
    }
    fresh_ = false;  // a cycle without read() has no new inputs
    if (!cycle.writing) {
        output_on_.store(false,
                         // relaxed, because the fast thread needs no other data of this thread
                         std::memory_order_relaxed);
        rewrite_due_ = true;
        return;
    }
    note_timeout(period_ns);
    const bool is_all = rewrite_due_ && cycle.fresh && isReadRecent(now_ns);
    const bool sent = bus_.write(registers_.list(is_all));
    rewrite_due_ = !sent || (rewrite_due_ && !is_all);
    output_on_.store(sent, std::memory_order_relaxed);
    if (sent) {
        note_write(now_ns);
    }
}

// Writing the configuration would turn on outputs that a bite has turned off. So all registers are written
// only if a recent read in this cycle has shown that the watchdog has not bitten; the process may have been
// suspended between read and write.
bool Board::isReadRecent(std::int64_t now_ns) const noexcept {
    return watchdog_ == nullptr || now_ns - read_ns_ < std::int64_t{watchdog_->timeout_ns()} / 2;
}

void Board::note_write(std::int64_t now_ns) noexcept {
    longest_gap_ns_ = written_ ? std::max(longest_gap_ns_, now_ns - last_write_ns_) : 0;
    last_write_ns_ = now_ns;
    written_ = true;
}

void Board::note_timeout(long period_ns) noexcept {
    const std::int64_t timeout_ns = watchdog_ == nullptr ? 0 : watchdog_->timeout_ns();
    if (timeout_ns == checked_timeout_ns_) {
        return;
    }
    checked_timeout_ns_ = timeout_ns;
    // A cycle that is half a period late must not cause a bite.
    events_.timeout_short = timeout_ns < period_ns + period_ns / 2;
}

void Board::read_gpio() noexcept {
    if (hasFastGpio()) {
        ports_->read_immediately(bus_);
    }
}

void Board::write_gpio() noexcept {
    if (hasFastGpio() && output_on_.load(std::memory_order_relaxed)) {
        ports_->write_immediately(bus_);
    }
}

BoardEvents Board::take_events() noexcept {
    const BoardEvents events = events_;
    events_ = {};
    return events;
}

std::size_t Board::take_message(std::span<char> text) noexcept {
    for (const auto &module : modules_) {
        if (const std::size_t length = module->take_message(text); length > 0) {
            return length;
        }
    }
    return 0;
}

bool Board::describe(int line, std::span<char> text) const noexcept {
    const int modules = static_cast<int>(assignment_.modules.size());
    if (line < modules) {
        const UsedModule &module = assignment_.modules[static_cast<std::size_t>(line)];
        const std::string_view name = module_name(module.descriptor.gtag);
        std::snprintf(text.data(), text.size(), "module %.*s version %d at 0x%04X: %d used, clock %u Hz",
                      static_cast<int>(name.size()), name.data(), module.descriptor.version,
                      module.descriptor.base_address, module.instances, module.clock_hz);
        return true;
    }
    const auto written = registers_.written(line - modules);
    if (written) {
        std::snprintf(text.data(), text.size(), "register 0x%04X = 0x%08X", written->address, written->value);
    }
    return written.has_value();
}

void Board::stop() noexcept {
    if (watchdog_ == nullptr || !written_) {
        return;  // the outputs are off, or another host controls the board
    }
    // The minimum time of the watchdog passes before the next register could be written.
    const std::uint32_t shortest = 0;
    (void)bus_.write_now(watchdog_->timer_address(), std::span(&shortest, 1));
}

}  // namespace mw::mesa
