// SPDX-License-Identifier: GPL-2.0-or-later
// A machine for component tests: an instance under the virtual clock with one thread, driven by HAL commands.
#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "hal/script/session.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::components::test {

/// Keeps all output of a session.
class TextOutput final : public hal::script::Output {
  public:
    void data(std::string_view text) override { answers += text; }
    void info(std::string_view text) override { infos += std::string(text) + "\n"; }
    void note(std::string_view text) override { notes += std::string(text) + "\n"; }
    void warning(const Error &warning) override { warnings += warning.str() + "\n"; }
    void error(const Error &error) override { errors += error.str() + "\n"; }

    std::string answers, infos, notes, warnings, errors;
};

class Bench {
  public:
    static constexpr std::int64_t PERIOD_NS = 1000000;

    /// Loads threads with thread "t" of PERIOD_NS and runs `commands`, which add the functions.
    explicit Bench(const std::string &commands, std::int64_t period_ns = PERIOD_NS) : period_ns_(period_ns) {
        hal::InstanceOptions options;
        options.name = "component-test";
        options.scheduler = &clock;
        auto made = hal::LocalHost::create(options);
        EXPECT_TRUE(made.has_value()) << made.error().str();
        host = std::move(*made);
        session = std::make_unique<hal::script::Session>(*host, programs, output);
        run("loadrt threads name1=t period1=" + std::to_string(period_ns) + "\n" + commands + "\nstart\n");
        EXPECT_EQ(output.errors, "");
    }

    void run(const std::string &commands) { (void)session->run_text(commands, "test"); }
    hal::Instance &hal() { return host->hal(); }

    /// Runs `periods` periods of the thread.
    void pass(int periods = 1) { clock.run_until(clock.now_ns() + periods * period_ns_); }
    /// Uses setp, or sets the signal when there is no such pin.
    void set(const std::string &name, double value) {
        const auto pin = hal().values().get(name);
        ASSERT_TRUE(pin.has_value()) << name;
        const Result<> result = hal().values().set(name, hal_value(pin->type, value));
        ASSERT_TRUE(result.has_value()) << result.error().str();
    }
    double get(const std::string &name) {
        const auto value = hal().values().get(name);
        EXPECT_TRUE(value.has_value()) << name;
        return value ? value->as_number() : 0.0;
    }
    /// Sets an input, runs one period and reads an output.
    double after(const std::string &input, double value, const std::string &output_pin) {
        set(input, value);
        pass();
        return get(output_pin);
    }

    runtime::VirtualScheduler clock;
    hal::script::InProcessProgramHost programs;
    TextOutput output;
    std::unique_ptr<hal::LocalHost> host;
    std::unique_ptr<hal::script::Session> session;

  private:
    static hal::Value hal_value(hal::Type type, double value) {
        switch (type) {
        case hal::Type::BIT: return hal::Value::of_bit(value != 0.0);
        case hal::Type::FLOAT: return hal::Value::of_float(value);
        case hal::Type::S32: return hal::Value::of_s32(static_cast<std::int32_t>(value));
        case hal::Type::U32: return hal::Value::of_u32(static_cast<std::uint32_t>(value));
        case hal::Type::S64: return hal::Value::of_s64(static_cast<std::int64_t>(value));
        default: return hal::Value::of_u64(static_cast<std::uint64_t>(value));
        }
    }

    std::int64_t period_ns_;
};

}  // namespace mw::components::test
