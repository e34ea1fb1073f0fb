// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/modbus/component.hh"

#include <modbus.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "hal/include/hal.h"

namespace mw::modbus {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto RECONNECT_AFTER = std::chrono::milliseconds(500);
constexpr auto LOOK_AFTER =
    std::chrono::milliseconds(20);  ///< interval at which a waiting thread checks for the end
constexpr double MIN_REGISTER = -32768, MAX_REGISTER = 65535;

/// The pins of one element.
struct Element {
    hal_bit_t *bit = nullptr, *bit_inv = nullptr;
    hal_float_t *number = nullptr;
    hal_s32_t *whole = nullptr;
};

/// Pins in HAL memory.
struct Pins {
    Element *elements = nullptr;
    hal_u32_t **num_errors = nullptr;
};

/// The elements of one transaction with their last values, and the state of its device.
struct Work {
    const Transaction *asked = nullptr;
    Pins pins;
    Clock::time_point due{};
    bool failing = false;
};

struct FreeContext {
    void operator()(modbus_t *context) const {
        modbus_close(context);
        modbus_free(context);
    }
};
using Context = std::unique_ptr<modbus_t, FreeContext>;

Result<> make_element(int id, const std::string &prefix, const Transaction &one, Element &into) {
    const hal_pin_dir_t way = isRead(one.function) ? HAL_OUT : HAL_IN;
    int done = 0;
    if (isOfBits(one.function)) {
        done = hal_pin_bit_newf(way, &into.bit, id, "%s.bit", prefix.c_str());
        if (done == 0 && isRead(one.function)) {
            done = hal_pin_bit_newf(way, &into.bit_inv, id, "%s.bit-inv", prefix.c_str());
        }
        if (done == 0 && isRead(one.function)) {
            *into.bit_inv = true;
        }
    } else {
        done = hal_pin_float_newf(way, &into.number, id, "%s.float", prefix.c_str());
        done = done == 0 ? hal_pin_s32_newf(way, &into.whole, id, "%s.int", prefix.c_str()) : done;
    }
    return done == 0 ? Result<>{} : fail("HAL does not accept the pins " + prefix + ".*");
}

Result<Pins> make_pins(int id, const std::string &component, const Transaction &one) {
    Pins pins;
    pins.elements =
        static_cast<Element *>(hal_malloc(static_cast<long>(sizeof(Element) * one.elements.size())));
    pins.num_errors = static_cast<hal_u32_t **>(hal_malloc(static_cast<long>(sizeof(hal_u32_t *))));
    if (pins.elements == nullptr || pins.num_errors == nullptr) {
        return fail("there is no HAL memory left for transaction " + one.name);
    }
    const std::string prefix = component + '.' + one.name;
    for (std::size_t i = 0; i < one.elements.size(); ++i) {
        pins.elements[i] = Element{};
        if (auto made = make_element(id, prefix + '.' + one.elements[i], one, pins.elements[i]); !made) {
            return std::unexpected(made.error());
        }
    }
    if (hal_pin_u32_newf(HAL_OUT, pins.num_errors, id, "%s.num_errors", prefix.c_str()) != 0) {
        return fail("HAL does not accept the pin " + prefix + ".num_errors");
    }
    return pins;
}

/// The register value of both pins: 0 to 65535; negative numbers as signed 16-bit values.
std::uint16_t register_of(const Element &element) {
    const double sum = *element.number + *element.whole;
    const double limited = std::isnan(sum) ? 0.0 : std::clamp(std::trunc(sum), MIN_REGISTER, MAX_REGISTER);
    return static_cast<std::uint16_t>(static_cast<std::int32_t>(limited));
}

/// One link and its transactions, in one thread, because they are sequential on the wire.
class LinkWork {
  public:
    LinkWork(const Link &link, std::string component, double slowdown_s,
             const volatile std::sig_atomic_t &stop)
        : link_(link), component_(std::move(component)), slowdown_s_(slowdown_s), stop_(stop) {}

    void add(Work work) { works_.push_back(work); }

    void run() {
        while (stop_ == 0) {
            Work &next = *std::ranges::min_element(works_, {}, &Work::due);
            if (next.due > Clock::now()) {
                std::this_thread::sleep_for(std::min<Clock::duration>(next.due - Clock::now(), LOOK_AFTER));
                continue;
            }
            const bool done = connect(next) && carry_out(next);
            tell(next, done);
            const double rate = next.asked->max_rate_hz;
            const auto period =
                rate > 0
                    ? std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / rate))
                    : std::chrono::milliseconds(1);
            next.due = Clock::now() +
                       (context_ == nullptr ? std::max<Clock::duration>(period, RECONNECT_AFTER) : period);
            const double rest_s = slowdown_s_ + (link_.is_tcp ? 0.0 : next.asked->delay_ms / 1000.0);
            std::this_thread::sleep_for(std::chrono::duration<double>(rest_s));
        }
    }

  private:
    bool connect(const Work &work) {
        if (context_ == nullptr) {
            context_.reset(link_.is_tcp ? modbus_new_tcp(link_.address.c_str(), link_.port)
                                        : modbus_new_rtu(link_.device.c_str(), link_.baud, link_.parity,
                                                         link_.bits, link_.stop));
            if (context_ == nullptr) {
                return false;
            }
            modbus_set_debug(context_.get(), work.asked->debug >= 3 ? 1 : 0);
            set_times(work);
            if (modbus_connect(context_.get()) != 0) {
                const int reason = errno;
                context_.reset();
                errno = reason;
                return false;
            }
        }
        set_times(work);
        return modbus_set_slave(context_.get(), work.asked->slave) == 0;
    }

    void set_times(const Work &work) {
        const auto us = [](int ms) { return static_cast<std::uint32_t>(ms % 1000) * 1000U; };
        const auto s = [](int ms) { return static_cast<std::uint32_t>(ms / 1000); };
        const Transaction &one = *work.asked;
        modbus_set_response_timeout(context_.get(), s(one.response_timeout_ms), us(one.response_timeout_ms));
        modbus_set_byte_timeout(context_.get(), s(one.byte_timeout_ms), us(one.byte_timeout_ms));
    }

    bool carry_out(Work &work) {
        const bool done = isRead(work.asked->function) ? read(work) : write(work);
        // A lost connection is opened again; after an exception response the connection remains open.
        if (!done && errno < MODBUS_ENOBASE) {
            const int reason = errno;
            context_.reset();
            errno = reason;
        } else if (!done) {
            const int reason = errno;
            modbus_flush(context_.get());
            errno = reason;
        }
        return done;
    }

    bool read(Work &work) {
        const Transaction &one = *work.asked;
        const auto count = static_cast<int>(one.elements.size());
        if (isOfBits(one.function)) {
            const auto ask = one.function == Function::READ_COILS ? modbus_read_bits : modbus_read_input_bits;
            if (ask(context_.get(), one.first_element, count, bits_.data()) != count) {
                return false;
            }
            for (int i = 0; i < count; ++i) {
                *work.pins.elements[i].bit = bits_[static_cast<std::size_t>(i)] != 0;
                *work.pins.elements[i].bit_inv = bits_[static_cast<std::size_t>(i)] == 0;
            }
            return true;
        }
        const auto ask = one.function == Function::READ_HOLDING_REGISTERS ? modbus_read_registers
                                                                          : modbus_read_input_registers;
        if (ask(context_.get(), one.first_element, count, registers_.data()) != count) {
            return false;
        }
        for (int i = 0; i < count; ++i) {
            *work.pins.elements[i].number = registers_[static_cast<std::size_t>(i)];
            *work.pins.elements[i].whole = registers_[static_cast<std::size_t>(i)];
        }
        return true;
    }

    bool write(Work &work) {
        const Transaction &one = *work.asked;
        const std::size_t count = one.elements.size();
        for (std::size_t i = 0; i < count; ++i) {
            if (isOfBits(one.function)) {
                bits_[i] = *work.pins.elements[i].bit ? 1 : 0;
            } else {
                registers_[i] = register_of(work.pins.elements[i]);
            }
        }
        const auto all = static_cast<int>(count);
        switch (one.function) {
        case Function::WRITE_MULTIPLE_COILS:
            return modbus_write_bits(context_.get(), one.first_element, all, bits_.data()) == all;
        case Function::WRITE_MULTIPLE_REGISTERS:
            return modbus_write_registers(context_.get(), one.first_element, all, registers_.data()) == all;
        default: break;
        }
        for (int i = 0; i < all; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const int done =
                isOfBits(one.function)
                    ? modbus_write_bit(context_.get(), one.first_element + i, bits_[k])
                    : modbus_write_register(context_.get(), one.first_element + i, registers_[k]);
            if (done != 1) {
                return false;
            }
        }
        return true;
    }

    void tell(Work &work, bool done) {
        const Transaction &one = *work.asked;
        if (!done) {
            **work.pins.num_errors = **work.pins.num_errors + 1;
        }
        if (one.debug >= 1 && work.failing == done) {
            const std::string device =
                link_.is_tcp ? link_.address + ':' + std::to_string(link_.port) : link_.device;
            language::tell(fmt::format("{}: transaction {}, slave {} at {}: {}", component_, one.name,
                                       one.slave, device, done ? "answers again" : modbus_strerror(errno)));
        } else if (one.debug >= 2 && done) {
            language::tell(fmt::format("{}: transaction {}: done", component_, one.name));
        }
        work.failing = !done;
    }

    const Link &link_;
    std::string component_;
    double slowdown_s_;
    const volatile std::sig_atomic_t &stop_;
    std::vector<Work> works_;
    Context context_;
    std::array<std::uint8_t, MODBUS_MAX_READ_BITS> bits_{};
    std::array<std::uint16_t, MODBUS_MAX_READ_REGISTERS> registers_{};
};

}  // namespace

Result<> run(const Setup &setup, const volatile std::sig_atomic_t &stop) {
    const int id = hal_init(setup.component.c_str());
    if (id < 0) {
        return fail("HAL does not accept component " + setup.component, {},
                    "a component with this name may already exist");
    }
    std::vector<LinkWork> links;
    links.reserve(setup.links.size());
    for (const Link &link : setup.links) {
        links.emplace_back(link, setup.component, setup.slowdown_s, stop);
    }
    for (const Transaction &one : setup.transactions) {
        const auto pins = make_pins(id, setup.component, one);
        if (!pins) {
            hal_exit(id);
            return std::unexpected(pins.error());
        }
        links[one.link].add({.asked = &one, .pins = *pins});
    }
    hal_ready(id);
    std::vector<std::thread> threads;
    for (LinkWork &link : links) {
        threads.emplace_back([&link] { link.run(); });
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
    hal_exit(id);
    return {};
}

}  // namespace mw::modbus
