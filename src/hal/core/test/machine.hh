// SPDX-License-Identifier: GPL-2.0-or-later
// A HAL instance under virtual time, for tests.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/core/host.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::hal {

/// Collects log messages.
struct Messages {
    std::vector<std::string> lines;
    runtime::Log log{runtime::Log::Mode::SYNCHRONOUS,
                     [](void *self, runtime::LogLevel, const char *text) {
                         static_cast<Messages *>(self)->lines.emplace_back(text);
                     },
                     this};

    std::string all() const {
        std::string text;
        for (const std::string &line : lines) {
            text += line + '\n';
        }
        return text;
    }
};

struct TestMachine {
    Messages messages;
    runtime::VirtualScheduler clock;
    std::unique_ptr<LocalHost> host;

    explicit TestMachine(const std::string &name = "test") {
        InstanceOptions options;
        options.name = name;
        options.scheduler = &clock;
        options.log = &messages.log;
        auto made = LocalHost::create(options, {MW_TEST_MODULES});
        if (made) {
            host = std::move(*made);
        }
    }
    Instance &hal() { return host->hal(); }
    std::string load(const std::string &name, const std::vector<std::string> &args = {}) {
        auto done = host->load_realtime(name, args);
        return done ? "ok" : done.error().str();
    }
    Value value(const std::string &name) {
        return host->hal().values().get(name).value_or(Value::of_s64(-999));
    }
};

/// "ok", or the error's text.
inline std::string text_of(const Result<> &result) {
    return result ? "ok" : result.error().str();
}

}  // namespace mw::hal
