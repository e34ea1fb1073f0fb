// SPDX-License-Identifier: GPL-2.0-or-later
// HAL for screens: list of objects, watched values, setting of values, and the oscilloscope.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/screen/hal/dialogs.hh"
#include "clients/screen/http/http_types.hh"
#include "hal/core/host.hh"
#include "hal/tools/view/capture.hh"

namespace mw::screen {

/// Reads and sets the HAL of the machine. All methods may block while HAL is busy; call them in a thread
/// other than the server's, one at a time.
class HalService {
  public:
    /// Joins the realtime process; an error contains the reason.
    using Connect = std::function<Result<std::unique_ptr<hal::Host>>()>;
    /// Maximum number of points of a record sent to screens.
    static constexpr std::uint32_t MOST_SAMPLES = 100000;

    /// Called once, when HAL and the pins of dialogs exist; it returns notes for the operator.
    using Begin = std::function<std::vector<std::string>()>;

    explicit HalService(Connect connect, std::vector<DialogFacts> dialogs = {}, Begin begin = nullptr)
        : connect_(std::move(connect)), begin_(std::move(begin)), dialogs_(std::move(dialogs)) {}

    /// {"pins": [...], "signals": [...], "params": [...]} of the matching names.
    Response list(const std::string &glob);
    /// {"probe": true, "spindles": [{"speed_in": true, "at_speed": false}]}: the inputs of motion that have a
    /// source, that is a signal written by a pin. Without a source an input has only its preset.
    Response inputs();
    /// Sets a parameter, a pin without signal or a signal without writer; {"value": "..."}.
    Response set(const std::string &name, std::string_view body);
    struct News {
        /// The JSON of each value, "null" for a name that does not exist.
        std::map<std::string, std::string> values;
        std::string questions;           ///< questions for the operator, as a JSON list
        std::vector<std::string> notes;  ///< notes for the operator
        bool has_begun = false;          ///< `begin` has been called, or is empty
    };
    News look(const std::vector<std::string> &names);
    /// POST {"id": "door", "number": 0, "yes": true}: the operator's answer.
    Response answer(std::string_view body);

    /// POST begins a record with the settings in the body; DELETE removes the oscilloscope from its thread.
    Response scope(std::string_view method, std::string_view body);
    /// The complete record.
    Response record();
    /// Triggers the record now.
    Response force();

  private:
    /// Null if there is no host; `reason_` contains the reason.
    hal::Host *host();
    std::map<std::string, std::string> read(const std::vector<std::string> &names);
    void look_at_dialogs(News &news);
    Response state() const;
    Response begin(std::string_view body);

    Connect connect_;
    Begin begin_;
    std::unique_ptr<hal::Host> host_;
    std::optional<hal::view::Capture> capture_;
    std::string thread_;  ///< requested thread of capture_
    std::string reason_;
    Dialogs dialogs_;
    bool has_told_failure_ = false;  ///< it was reported that the pins of dialogs_ cannot be created
};

}  // namespace mw::screen
