// SPDX-License-Identifier: GPL-2.0-or-later
// ASCII and display: values as text.
//
//   ascii:    number,shape,value,value,...\n
//   display:  NAME number\n  then name=value\n for each, "joints[2].pos_cmd=1.5"; enumerations by name
//
// A real number is the shortest text that reads back as the same number, or inf, -inf, nan. Texts are in
// quotes and may contain
// \" \\ and \xHH. Bytes above 7f are unchanged.
#pragma once

#include <vector>

#include "clients/nml/message/format.hh"

namespace mw::nml {

enum class TextStyle { ASCII, DISPLAY };

class TextWriter final : public Format {
  public:
    TextWriter(TextStyle style, std::string &out) : style_(style), out_(out) {}
    bool isReading() const override { return false; }
    bool head(FrameHead &head) override;
    bool integer(const Value &value, std::int64_t &number) override;
    bool real(const Value &value, double &number) override;
    bool text(const Value &value, std::string_view &text, std::size_t longest) override;
    bool count(const Value &value, std::uint32_t &count) override;
    void enter(const Value &value) override;
    void leave() override;
    bool end() override;

  private:
    void put(const Value &value, std::string_view text);
    void put_line(const std::string &name, std::string_view text);

    TextStyle style_;
    std::string &out_;
    std::vector<std::string> path_;
};

class TextReader final : public Format {
  public:
    TextReader(TextStyle style, std::string_view bytes) : style_(style), bytes_(bytes) {}
    bool isReading() const override { return true; }
    bool head(FrameHead &head) override;
    bool integer(const Value &value, std::int64_t &number) override;
    bool real(const Value &value, double &number) override;
    bool text(const Value &value, std::string_view &text, std::size_t longest) override;
    bool count(const Value &value, std::uint32_t &count) override;
    void enter(const Value &value) override;
    void leave() override;
    bool end() override;

  private:
    bool take(const Value &value, std::string_view &text);
    bool take_name(const std::string &name);
    /// A value up to its end; texts with their quotes.
    bool take_value(std::string_view &text);

    TextStyle style_;
    std::string_view bytes_;
    std::vector<std::string> path_;
    std::string plain_;  ///< the last text, without quotes
};

}  // namespace mw::nml
