// SPDX-License-Identifier: GPL-3.0-or-later
// XML -> Document. The only user of tinyxml2.
#include "msml/document/document.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>

namespace msml {
namespace {

constexpr std::size_t largest_file = 64u << 20;
constexpr std::size_t most_tags = 1'000'000;
constexpr const char* scene_namespace = "http://sfb125.de/msml";

using Faults = std::vector<Fault>;

bool blank(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c); });
}

std::string without_margin(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// Length of the UTF-8 sequence that starts at text[i], or 0 if it is malformed.
std::size_t utf8_sequence(const std::string& text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(k < text.size() ? text[k] : 0); };
  const unsigned char first = byte(i);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte(i + k) & 0xC0) != 0x80) return 0;
  const bool overlong = (first == 0xE0 && byte(i + 1) < 0xA0) || (first == 0xF0 && byte(i + 1) < 0x90);
  const bool surrogate = first == 0xED && byte(i + 1) >= 0xA0, beyond = first == 0xF4 && byte(i + 1) >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

/// Line of the first byte that is not UTF-8 or is a control character XML forbids; 0 if there is none.
int bad_byte_line(const std::string& text) {
  int line = 1;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = utf8_sequence(text, i);
    if (length == 0 || (byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t')) return line;
    if (byte == '\n') ++line;
    i += length;
  }
  return 0;
}

/// True where `text` goes on with `words` at i.
bool goes_on(const std::string& text, std::size_t i, const char* words) {
  return text.compare(i, std::string::traits_type::length(words), words) == 0;
}

/// Refuses & where no character is meant by it: the parser would take it as it stands. Comments may hold it.
void refuse_entities(const std::string& text, Faults& faults, const std::string& file) {
  int line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') ++line;
    for (const auto& [open, close] : {std::pair{"<!--", "-->"}, {"<![CDATA[", "]]>"}})
      if (text[i] == '<' && goes_on(text, i, open)) {
        const std::size_t end = std::min(text.find(close, i), text.size() - 1);
        line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                            text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
        i = end;
      }
    if (text[i] != '&') continue;
    const std::size_t end = std::min(text.find_first_of("; \t\r\n\"'<>", i), text.size());
    const std::string entity = text.substr(i + 1, std::min<std::size_t>(end - i - 1, 40));
    const bool known = end < text.size() && text[end] == ';' &&
                       (entity == "amp" || entity == "lt" || entity == "gt" || entity == "quot" || entity == "apos" ||
                        (entity.starts_with('#') && entity.size() > 1));
    if (!known)
      faults.push_back(
          {{file, line}, fmt::format("&{} is no character XML knows; write &amp; for an ampersand", entity)});
  }
}

/// Why a text is not read at all, or "".
std::string size_problem(const std::string& text) {
  if (text.size() > largest_file)
    return fmt::format("the file has {} MiB, more than the {} MiB allowed; put large data in files of their own",
                       text.size() >> 20, largest_file >> 20);
  if (static_cast<std::size_t>(std::count(text.begin(), text.end(), '<')) > 2 * most_tags)
    return fmt::format("the file has more than the {} tags allowed", most_tags);
  return {};
}

class Reader {
 public:
  Reader(std::string file, Faults& faults) : file_(std::move(file)), faults_(faults) {}

  Element element(const tinyxml2::XMLElement& xml) {
    Element element{.tag = xml.Name(), .where = at(xml.GetLineNum())};
    for (const auto* a = xml.FirstAttribute(); a; a = a->Next())
      element.attributes.push_back({a->Name(), a->Value(), at(a->GetLineNum())});
    for (const auto* node = xml.FirstChild(); node; node = node->NextSibling()) child(element, *node);
    return element;
  }

  void fault(int line, std::string message) { faults_.push_back({at(line), std::move(message)}); }
  Location at(int line) const { return {file_, line}; }

 private:
  void child(Element& parent, const tinyxml2::XMLNode& node) {
    if (const auto* inner = node.ToElement()) {
      parent.children.push_back(element(*inner));
    } else if (node.ToUnknown()) {
      fault(node.GetLineNum(), fmt::format("a declaration (<!…>) inside {} is not allowed in a scene", parent.tag));
    } else if (const auto* text = node.ToText()) {
      if (!blank(text->Value()))
        fault(text->GetLineNum(), fmt::format("text '{}' inside {} has no meaning; values stand in attributes",
                                              shortened(without_margin(text->Value()), 40), parent.tag));
    }
  }

  std::string file_;
  Faults& faults_;
};

/// What stands beside the root. A document type could define entities that grow without bound; scenes need none.
void refuse_surroundings(const tinyxml2::XMLDocument& xml, Reader& reader) {
  bool declared = false;
  for (const auto* node = xml.FirstChild(); node; node = node->NextSibling()) {
    if (node->ToUnknown() && !declared)
      reader.fault(node->GetLineNum(), "document type and entity declarations (<!…>) are not allowed in a scene");
    declared = declared || node->ToUnknown();
    if (node->ToText() && !declared && !blank(node->Value()))
      reader.fault(node->GetLineNum(),
                   fmt::format("text '{}' stands outside the scene", shortened(without_margin(node->Value()), 40)));
  }
  for (const auto* second = xml.RootElement() ? xml.RootElement()->NextSiblingElement() : nullptr; second;
       second = second->NextSiblingElement())
    reader.fault(second->GetLineNum(),
                 fmt::format("<{}> stands after the end of the scene", shortened(second->Name())));
}

/// Accepts msml and msml:msml; checks the namespace where one is declared.
void check_root(Element& root, Reader& reader) {
  const std::size_t colon = root.tag.find(':');
  const std::string prefix = colon == std::string::npos ? "" : root.tag.substr(0, colon);
  const std::string tag = colon == std::string::npos ? root.tag : root.tag.substr(colon + 1);
  if (tag != "msml") {
    reader.fault(root.where.line, fmt::format("the root is <{}>, but a scene starts with <msml>", root.tag));
    return;
  }
  root.tag = tag;
  const Attribute* declared = root.find(prefix.empty() ? "xmlns" : "xmlns:" + prefix);
  if (declared && declared->value != scene_namespace)
    reader.fault(declared->where.line,
                 fmt::format("namespace '{}' is not '{}'", shortened(declared->value, 40), scene_namespace));
  std::erase_if(root.attributes, [](const Attribute& a) { return a.name.starts_with("xmlns"); });
}

std::string xml_problem(const tinyxml2::XMLDocument& xml) {
  using namespace tinyxml2;
  switch (xml.ErrorID()) {
    case XML_ERROR_EMPTY_DOCUMENT:
      return "the file is empty, but a scene starts with <msml>";
    case XML_ERROR_PARSING_ATTRIBUTE:
      return "malformed attribute: expected name=\"value\", each name once in a tag";
    case XML_ERROR_PARSING:
      return "a tag is malformed, or not closed by the end of the file";
    case XML_ERROR_MISMATCHED_ELEMENT:
      return "a tag is not closed, or is closed by another name";
    case XML_ERROR_PARSING_COMMENT:
      return "a comment <!-- is not closed by -->";
    case XML_ERROR_PARSING_CDATA:
      return "a CDATA section is not closed by ]]>";
    case XML_ERROR_PARSING_TEXT:
      return "text is not closed by a tag: the file ends too early";
    case XML_ERROR_PARSING_ELEMENT:
      return "malformed or unclosed tag: the file may end too early";
    case XML_ELEMENT_DEPTH_EXCEEDED:
      return fmt::format("tags are nested more than {} deep", TINYXML2_MAX_ELEMENT_DEPTH);
    default:
      return std::string("not well-formed XML: ") + xml.ErrorName();
  }
}

}  // namespace

const Attribute* Element::find(const std::string& name) const {
  for (const Attribute& attribute : attributes)
    if (attribute.name == name) return &attribute;
  return nullptr;
}

Document parse_document(const std::string& text, const std::string& file, Faults& faults) {
  Document document{.file = file, .folder = std::filesystem::path(file).parent_path(), .root = {}};
  Reader reader(file, faults);
  document.root.where = reader.at(1);
  if (const std::string problem = size_problem(text); !problem.empty()) {
    reader.fault(0, problem);
    return document;
  }
  if (const int line = bad_byte_line(text); line > 0) {
    reader.fault(line, "a byte here is not UTF-8 text");
    return document;
  }
  tinyxml2::XMLDocument xml;
  xml.Parse(text.data(), text.size());
  if (xml.Error()) {
    reader.fault(std::max(1, xml.ErrorLineNum()), xml_problem(xml));
    return document;
  }
  refuse_surroundings(xml, reader);
  if (!xml.RootElement()) {
    reader.fault(1, "the file holds no tag, but a scene starts with <msml>");
    return document;
  }
  document.root = reader.element(*xml.RootElement());
  refuse_entities(text, faults, file);
  check_root(document.root, reader);
  return document;
}

Document read_document(const std::filesystem::path& path, Faults& faults) {
  const auto refuse = [&](const std::string& message) {
    faults.push_back({{path.string(), 0}, message});
    return Document{.file = path.string(), .folder = path.parent_path(), .root = {}};
  };
  std::error_code code;
  if (!std::filesystem::exists(path, code)) return refuse("no such file");
  if (std::filesystem::is_directory(path, code)) return refuse("is a folder, not a scene");
  std::ifstream in(path, std::ios::binary);
  if (!in) return refuse("cannot be read");
  // A scene beyond the limit is refused by parse_document; no need to read all of a very large file for that.
  std::string text(std::min<std::uintmax_t>(std::filesystem::file_size(path, code), largest_file + 1), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return parse_document(text, path.string(), faults);
}

}  // namespace msml
