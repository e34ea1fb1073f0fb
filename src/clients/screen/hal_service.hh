// SPDX-License-Identifier: GPL-2.0-or-later
// HAL for screens: what there is, values that are watched, values that are set, and the oscilloscope.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/screen/dialogs.hh"
#include "clients/screen/http_types.hh"
#include "hal/core/host.hh"
#include "hal/tools/view/capture.hh"

namespace mw::screen {

/// Reads and sets the HAL of the machine. HAL may be busy, so that all of this blocks: in a thread beside the
/// server's, one call after the other.
class HalService {
  public:
    /// Joins the realtime process; an error says why there is none.
    using Connect = std::function<Result<std::unique_ptr<hal::Host>>()>;
    /// Points of a record that are sent to screens.
    static constexpr std::uint32_t MOST_SAMPLES = 100000;

    /// Called once, when HAL and the pins of dialogs are there; what it returns are notes for the operator.
    using Begin = std::function<std::vector<std::string>()>;

    explicit HalService(Connect connect, std::vector<DialogFacts> dialogs = {}, Begin begin = nullptr)
        : connect_(std::move(connect)), begin_(std::move(begin)), dialogs_(std::move(dialogs)) {}

    /// {"pins": [...], "signals": [...], "params": [...]} of the names that match.
    Response list(const std::string &glob);
    /// {"probe": true, "spindles": [{"speed_in": true, "at_speed": false}]}: which inputs of motion have a
    /// source, that is a signal that a pin writes. Without one such an input only has its preset.
    Response inputs();
    /// Of a parameter, a pin without signal or a signal without writer; {"value": "..."}.
    Response set(const std::string &name, std::string_view body);
    struct News {
        /// The JSON of each value, "null" for a name that there is not.
        std::map<std::string, std::string> values;
        std::string questions;           ///< a JSON list of what a person is asked
        std::vector<std::string> notes;  ///< for the operator
        bool has_begun = false;          ///< `begin` has been called, or there is none
    };
    News look(const std::vector<std::string> &names);
    /// POST {"id": "door", "number": 0, "yes": true}: a person's answer.
    Response answer(std::string_view body);

    /// POST begins a record with the settings of the body, DELETE takes the oscilloscope out of its thread.
    Response scope(std::string_view method, std::string_view body);
    /// The record that is done.
    Response record();
    /// Triggers now.
    Response force();

  private:
    /// Null, and `reason_` says why.
    hal::Host *host();
    std::map<std::string, std::string> read(const std::vector<std::string> &names);
    void look_at_dialogs(News &news);
    Response state() const;
    Response begin(std::string_view body);

    Connect connect_;
    Begin begin_;
    std::unique_ptr<hal::Host> host_;
    std::optional<hal::view::Capture> capture_;
    std::string thread_;  ///< of capture_, as it was asked for
    std::string reason_;
    Dialogs dialogs_;
    bool has_told_failure_ = false;  ///< that the pins of dialogs_ cannot be made
};

}  // namespace mw::screen
