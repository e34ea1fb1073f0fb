// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/hal/driver.hh"

#include <algorithm>
#include <cerrno>
#include <memory>

#include <fmt/format.h>

#include "drivers/mesa/hostmot2/board.hh"
#include "drivers/mesa/hostmot2/hal/hal_pins.hh"
#include "drivers/mesa/hostmot2/hal/log_idrom.hh"
#include "drivers/mesa/hostmot2/hal/serial.hh"
#include "drivers/mesa/identity/idrom.hh"
#include "hal.h"
#include "millwright_ext.h"
#include "rtapi.h"

namespace mw::mesa {

namespace {

constexpr long long NS_PER_US = 1000;

struct HalBoard {
    int comp_id = 0;
    std::string name;
    std::unique_ptr<Board> board;
    rtapi_u32 *lost_positions = nullptr;  ///< counter of HAL
    int dump_line = -1;                   ///< the next line of the state for the log; negative: none
};

DriverOptions &options() {
    static DriverOptions instance;
    return instance;
}

std::vector<std::unique_ptr<HalBoard>> &boards() {
    static std::vector<std::unique_ptr<HalBoard>> all;
    return all;
}

/// Messages of modules. [servo thread]
void report_modules(HalBoard &board) noexcept {
    constexpr int MOST_IN_A_CYCLE = 8;
    char text[512];
    for (int i = 0; i < MOST_IN_A_CYCLE; ++i) {
        const std::size_t length = board.board->take_message(text);
        if (length == 0) {
            return;
        }
        rtapi_print_msg(RTAPI_MSG_ERR, "hm2/%s: %.*s", board.name.c_str(), static_cast<int>(length), text);
    }
}

const char *text_of(PositionLoss loss) noexcept {
    switch (loss) {
    case PositionLoss::NONE: break;
    case PositionLoss::BITTEN:
        return "The watchdog has bitten while step generators were enabled: the motors have not followed "
               "them.";
    case PositionLoss::STOPPED: return "The board is not followed any more, because its traffic has stopped.";
    case PositionLoss::RETURNED: return "The board is followed again; what it did meanwhile is not known.";
    case PositionLoss::RESTARTED:
        return "The board has restarted, and lost its counters. Was it without power?";
    }
    return "";
}

/// Reports lost positions: motion switches off before its next command, and the message contains the cause.
void report_lost_positions(const HalBoard &board, PositionLoss loss) noexcept {
    __atomic_fetch_add(board.lost_positions, 1, __ATOMIC_RELAXED);
    rtapi_print_msg(RTAPI_MSG_ERR, "hm2/%s: %s Positions are lost: home all joints.", board.name.c_str(),
                    text_of(loss));
}

/// Writes one message for each event. [servo thread]
void report(HalBoard &board) noexcept {
    const BoardEvents events = board.board->take_events();
    const char *name = board.name.c_str();
    if (events.bitten) {
        rtapi_print_msg(
            RTAPI_MSG_ERR,
            "hm2/%s: The watchdog has bitten: all outputs are off. The longest time between two writes "
            "was %lld us, the limit is %lld us; failed reads before: %d. Clear %s.watchdog.has_bit.",
            name, static_cast<long long>(events.longest_gap_ns) / NS_PER_US,
            static_cast<long long>(board.board->timeout_ns()) / NS_PER_US, events.failed_reads, name);
    }
    if (events.timeout_short) {
        rtapi_print_msg(
            RTAPI_MSG_ERR,
            "hm2/%s: watchdog.timeout_ns is %lld, less than 1.5 periods of the thread. Increase it.", name,
            static_cast<long long>(board.board->timeout_ns()));
    }
    if (events.dump_requested) {
        board.dump_line = 0;
    }
}

/// Writes one line of the state in each cycle, so that the log does not overflow. [servo thread]
void dump(HalBoard &board) noexcept {
    constexpr std::size_t MAX_LINE = 128;
    char text[MAX_LINE];
    if (board.dump_line >= 0 && board.board->describe(board.dump_line, text)) {
        rtapi_print("hm2/%s: %s\n", board.name.c_str(), text);
        ++board.dump_line;
    } else {
        board.dump_line = -1;
    }
}

void read_function(void *self, long period_ns) {
    auto &board = *static_cast<HalBoard *>(self);
    board.board->read(period_ns, rtapi_get_time());
    // Checked before functions of this thread use the positions.
    if (const PositionLoss loss = board.board->take_position_loss(); loss != PositionLoss::NONE) {
        report_lost_positions(board, loss);
    }
}
void request_function(void *self, long) {
    static_cast<HalBoard *>(self)->board->request();
}
void trigger_function(void *self, long) {
    static_cast<HalBoard *>(self)->board->trigger_encoders();
}
void write_function(void *self, long period_ns) {
    auto &board = *static_cast<HalBoard *>(self);
    board.board->write(period_ns, rtapi_get_time());
    report(board);
    report_modules(board);
    dump(board);
}

void read_gpio_function(void *self, long) {
    static_cast<HalBoard *>(self)->board->read_gpio();
}
void write_gpio_function(void *self, long) {
    static_cast<HalBoard *>(self)->board->write_gpio();
}

int export_functions(HalBoard &board) {
    std::vector<std::pair<const char *, void (*)(void *, long)>> functions = {
        {"read", read_function}, {"read-request", request_function}, {"write", write_function}};
    if (board.board->hasFastGpio()) {
        functions.emplace_back("read_gpio", read_gpio_function);
        functions.emplace_back("write_gpio", write_gpio_function);
    }
    if (board.board->hasTriggers()) {
        functions.emplace_back("trigger-encoders", trigger_function);
    }
    for (const auto &[name, function] : functions) {
        const std::string full = board.name + "." + name;
        if (const int status = hal_export_funct(full.c_str(), function, &board, 1, 0, board.comp_id);
            status < 0) {
            return status;
        }
    }
    return 0;
}

/// Writes each line of a message as a message of the board.
int refuse(const std::string &name, std::string_view text) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        rtapi_print_msg(RTAPI_MSG_ERR, "hm2/%s: %.*s\n", name.c_str(), static_cast<int>(end), text.data());
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return -EIO;
}

}  // namespace

void set_driver_options(const DriverOptions &wanted) {
    options() = wanted;
}
const DriverOptions &driver_options() noexcept {
    return options();
}

int register_board(const BoardRequest &request) {
    auto config = parse_config(request.config);
    if (!config) {
        refuse(request.name, config.error().message);
        return -EINVAL;
    }
    config->is_named_by_serial_number = options().is_named_by_serial_number;
    config->sserial_baudrate = options().sserial_baudrate;
    const RegisterReader read = [&](std::uint16_t address, int count) {
        return request.bus->read_now({.address = address, .count = static_cast<std::uint16_t>(count)});
    };
    const auto idrom =
        decode_idrom(read, {.ports = static_cast<std::uint32_t>(request.bus->connectors().size()),
                            .port_width = static_cast<std::uint32_t>(request.bus->port_width())});
    if (!idrom) {
        refuse(request.name, idrom.error().message);
        return refuse(request.name, idrom.error().hint);
    }
    log_idrom(request.name, *idrom, options());
    auto board = Board::make(*request.bus, *idrom, *config);
    if (!board) {
        refuse(request.name, board.error().message);
        return -EINVAL;
    }
    for (const std::string &warning : (*board)->warnings()) {
        rtapi_print_msg(RTAPI_MSG_WARN, "hm2/%s: %s\n", request.name.c_str(), warning.c_str());
    }
    HalPins pins(request.comp_id, request.name);
    (*board)->declare(pins);
    if (pins.status() < 0) {
        return pins.status();
    }
    register_ports(request.name, (*board)->ports());
    auto made = std::make_unique<HalBoard>(
        HalBoard{request.comp_id, request.name, std::move(*board), mw_ext_lost_positions()});
    boards().push_back(std::move(made));
    const int status = export_functions(*boards().back());
    if (status < 0) {
        unregister_ports(request.name);
        boards().pop_back();
    }
    return status;
}

void unregister_boards(int comp_id) {
    std::erase_if(boards(), [&](const std::unique_ptr<HalBoard> &board) {
        const bool of_it = board->comp_id == comp_id;
        if (of_it) {
            unregister_ports(board->name);
            board->board->stop();
        }
        return of_it;
    });
}

}  // namespace mw::mesa
