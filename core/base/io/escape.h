// Escaping of text for HTML, XML and Markdown.
#pragma once

#include <string>
#include <string_view>

namespace stopline {

// Returns the text escaped for HTML content and for attributes in double quotes. Control characters that HTML forbids
// become U+FFFD.
std::string escape_html(std::string_view text);

// Returns the text escaped for XML attributes in double quotes. Control characters that XML 1.0 forbids become '?'.
std::string escape_xml(std::string_view text);

// Returns the text escaped for a cell of a Markdown table. Line breaks become spaces.
std::string escape_markdown_cell(std::string_view text);

}  // namespace stopline
