// SPDX-License-Identifier: GPL-2.0-or-later
// The interface of an encoding for update functions: one visitor that writes values to bytes or reads them in
// the same order.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.hh"
#include "messages/declarations/describe.hh"

namespace mw::nml {

/// The frame before every message.
struct FrameHead {
    int number = 0;
    /// Hash of the names and types of all fields, so that two programs with different declarations of a
    /// message detect this.
    std::uint32_t shape = 0;
    std::string_view name;
};

/// A value and its position in the message.
struct Value {
    const messages::Field &field;
    std::size_t index;  ///< index in an array or list
};

/// Each function returns false if the bytes do not have the requested value; problem() returns the reason.
class Format {
  public:
    virtual ~Format() = default;
    /// True if values are read from bytes.
    virtual bool isReading() const = 0;
    /// An encoding without a shape leaves it 0.
    virtual bool head(FrameHead &head) = 0;
    virtual bool integer(const Value &value, std::int64_t &number) = 0;
    virtual bool real(const Value &value, double &number) = 0;
    /// A text of at most `longest` bytes. A text that was read is valid until the next call.
    virtual bool text(const Value &value, std::string_view &text, std::size_t longest) = 0;
    /// Number of entries of a list.
    virtual bool count(const Value &value, std::uint32_t &count) = 0;
    /// The calls between enter and leave are for the values of a struct within the message.
    virtual void enter(const Value &) {}
    virtual void leave() {}
    /// End of the message; when reading there must be no further bytes.
    virtual bool end() = 0;

    const std::string &problem() const { return problem_; }

  protected:
    bool refuse(std::string problem) {
        problem_ = std::move(problem);
        return false;
    }

  private:
    std::string problem_;
};

/// Passes every field to the format, in the order of its declaration; when reading, the fields receive the
/// values. An error names message and field.
Result<> update(Format &format, const messages::Object &message);

/// Shape for FrameHead.
std::uint32_t shape_of(const messages::Declaration &head, const messages::Declaration &body);

}  // namespace mw::nml
