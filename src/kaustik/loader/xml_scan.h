#pragma once
// Where the pieces of an XML text begin and end, for those who look at it before or besides a
// parser.

#include <string>
#include <string_view>

namespace kaustik {

inline constexpr std::string_view xml_white_space = " \t\r\n";
inline constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

/// The end of a comment, of CDATA, of a processing instruction or of a declaration such as a
/// DOCTYPE that starts at `begin`; npos if it does not end.
size_t end_of_special(std::string_view text, size_t begin);

/// The end of the tag that starts at `begin`, whose quoted text may hold a '>'; npos if it does not
/// end.
size_t end_of_tag(std::string_view text, size_t begin);

/// Where the DOCTYPE stands before the first element; npos if there is none.
size_t find_doctype(std::string_view text);

/// The end of the name that starts at `begin`; `begin` if none does.
size_t end_of_name(std::string_view text, size_t begin);

/// The tag of the first element, which may be all that is sound; "" if something else comes first.
std::string root_tag(std::string_view text);

}  // namespace kaustik
