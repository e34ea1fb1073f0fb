// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/script/placeholders.hh"

#include <algorithm>

#include <fmt/format.h>

#include "hal/script/programs.hh"

namespace mw::hal::script {

void Placeholders::add_program(const std::string &component, const std::vector<std::string> &argv) {
    Program program;
    program.component = component;
    program.words.push_back(component);
    for (const std::string &word : argv) {
        program.words.push_back(base_name(word));
        program.command += (program.command.empty() ? "" : " ") + word;
    }
    programs_.push_back(std::move(program));
}

const Placeholders::Program *Placeholders::owner_of(const std::string &pin) const {
    const std::string prefix = pin.substr(0, pin.find('.'));
    for (const Program &program : programs_) {
        if (std::find(program.words.begin(), program.words.end(), prefix) != program.words.end()) {
            return &program;
        }
    }
    return nullptr;
}

Placeholders::Program *Placeholders::owner_of(const std::string &pin) {
    return const_cast<Program *>(static_cast<const Placeholders *>(this)->owner_of(pin));
}

bool Placeholders::covers(const std::string &name) const {
    return owner_of(name) != nullptr && !hal_.pins().has(name);
}

void Placeholders::note(const std::string &pin) {
    Program *program = owner_of(pin);
    if (program != nullptr &&
        std::find(program->pins.begin(), program->pins.end(), pin) == program->pins.end()) {
        program->pins.push_back(pin);
    }
}

Result<> Placeholders::make(const std::string &pin, const std::string &signal, Type type) {
    if (comp_id_ == 0) {
        const Result<int> made = hal_.components().create("left-out-programs");
        if (!made) {
            return std::unexpected(made.error());
        }
        comp_id_ = *made;
    }
    // Pins can be added only while a component is not ready.
    (void)hal_.components().set_ready(comp_id_, false);
    // An input never conflicts with another pin; as no pin writes the signal, it keeps its value.
    const Result<void **> slot = hal_.pins().create(pin, type, Dir::IN, comp_id_);
    if (!slot) {
        return std::unexpected(slot.error());
    }
    const Result<> ready = hal_.components().set_ready(comp_id_);
    return ready ? hal_.signals().link(pin, signal) : ready;
}

Result<> Placeholders::link(const std::string &pin, const std::string &signal) {
    note(pin);
    const Result<SignalInfo> info = hal_.signals().find(signal);
    if (!info) {
        waiting_.push_back({pin, signal});
        return {};
    }
    return make(pin, signal, info->type);
}

Result<> Placeholders::signal_made(const std::string &signal) {
    if (waiting_.empty()) {
        return {};
    }
    const Result<SignalInfo> info = hal_.signals().find(signal);
    if (!info) {
        return {};
    }
    std::vector<Waiting> rest;
    Result<> result;
    for (const Waiting &waiting : waiting_) {
        if (waiting.signal != signal) {
            rest.push_back(waiting);
        } else if (covers(waiting.pin) && result) {
            result = make(waiting.pin, signal, info->type);
        }
    }
    waiting_ = std::move(rest);
    return result;
}

std::vector<std::string> Placeholders::report() const {
    std::vector<std::string> lines;
    for (const Program &program : programs_) {
        std::string line = fmt::format("not started: {}", program.command);
        for (std::size_t i = 0; i < program.pins.size(); ++i) {
            line += (i == 0 ? "; pins without effect: " : ", ") + program.pins[i];
        }
        lines.push_back(std::move(line));
    }
    return lines;
}

}  // namespace mw::hal::script
