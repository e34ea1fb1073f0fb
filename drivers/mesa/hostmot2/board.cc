// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/board.hh"

#include <algorithm>

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
    if (config.isRawEnabled) {
        board->modules_.push_back(make_raw());
    }
    for (const auto &module : board->modules_) {
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
    case Gtag::IO_PORT:
        modules_.push_back(
            std::make_unique<IoPorts>(module, assignment_, static_cast<int>(idrom.header.port_width)));
        return;
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

void Board::read(long period_ns, std::int64_t now_ns) noexcept {
    const CycleRead result = bus_.read(registers_.inputs(), period_ns);
    isFresh_ = result == CycleRead::DONE;
    isStopped_ = result == CycleRead::STOPPED;
    isReadOnce_ = isReadOnce_ || isFresh_;
    isRewriteDue_ = bus_.take_rewrite() || isRewriteDue_;
    isWriteDoubtful_ = isWriteDoubtful_ || isRewriteDue_ || !isFresh_;
    if (!isFresh_) {
        ++failed_reads_;
        return;
    }
    Cycle cycle = cycle_of(period_ns);
    cycle.isFresh = true;
    cycle.hasLostWrite = isWriteDoubtful_;
    isWriteDoubtful_ = false;
    cycle.now_ns = now_ns != 0 ? now_ns : last_write_ns_ + period_ns;
    for (const auto &module : modules_) {
        module->read(registers_, cycle);
    }
    if (watchdog_ != nullptr && watchdog_->take_bite()) {
        events_.hasBitten = true;
        events_.longest_gap_ns = longest_gap_ns_;
        events_.failed_reads = failed_reads_;
        longest_gap_ns_ = 0;
    }
    failed_reads_ = 0;
}

void Board::write(long period_ns, std::int64_t now_ns) noexcept {
    Cycle cycle = cycle_of(period_ns);
    cycle.isFresh = isFresh_;
    cycle.now_ns = now_ns;
    const bool hasBitten = watchdog_ != nullptr && watchdog_->isBitten();
    cycle.isWriting = isReadOnce_ && !isStopped_ && !hasBitten;
    for (const auto &module : modules_) {
        module->write(registers_, cycle);
    }
    isRewriteDue_ = bus_.take_rewrite() || isRewriteDue_;
    if (watchdog_ != nullptr) {
        isRewriteDue_ = isRewriteDue_ || watchdog_->isRewriteWanted();
        cycle.isWriting = cycle.isWriting && !watchdog_->isBitten();
    }
    isFresh_ = false;  // a cycle without read() has no new inputs
    if (!cycle.isWriting) {
        isRewriteDue_ = true;
        return;
    }
    note_timeout(period_ns);
    const bool isSent = bus_.write(registers_.list(isRewriteDue_));
    isRewriteDue_ = !isSent;
    if (isSent) {
        note_write(now_ns);
    }
}

void Board::note_write(std::int64_t now_ns) noexcept {
    longest_gap_ns_ = hasWritten_ ? std::max(longest_gap_ns_, now_ns - last_write_ns_) : 0;
    last_write_ns_ = now_ns;
    hasWritten_ = true;
}

void Board::note_timeout(long period_ns) noexcept {
    const std::int64_t timeout_ns = watchdog_ == nullptr ? 0 : watchdog_->timeout_ns();
    if (timeout_ns == checked_timeout_ns_) {
        return;
    }
    checked_timeout_ns_ = timeout_ns;
    // A cycle that is half a period late must not be a bite.
    events_.isTimeoutShort = timeout_ns < period_ns + period_ns / 2;
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

void Board::stop() noexcept {
    if (watchdog_ == nullptr) {
        return;
    }
    // The shortest time of the watchdog passes before the next register could be written.
    const std::uint32_t shortest = 0;
    (void)bus_.write_now(watchdog_->timer_address(), std::span(&shortest, 1));
}

}  // namespace mw::mesa
