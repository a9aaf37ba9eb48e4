// SPDX-License-Identifier: GPL-3.0-or-later
// XML -> Document. The only user of tinyxml2.
#include "msml/document/document.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>

namespace msml {
namespace {

constexpr std::size_t largest_file = 64u << 20;
constexpr const char* scene_namespace = "http://sfb125.de/msml";

using Faults = std::vector<Fault>;

bool blank(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isspace(c); });
}

std::string shortened(const std::string& text) { return text.size() > 40 ? text.substr(0, 40) + "…" : text; }

/// Length of the UTF-8 sequence that starts at text[i], or 0 if it is malformed.
std::size_t utf8_sequence(const std::string& text, std::size_t i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(k < text.size() ? text[k] : 0); };
  const unsigned char first = byte(i);
  const std::size_t length = first < 0x80 ? 1 : first >= 0xC2 && first < 0xE0 ? 2 : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4 : 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte(i + k) & 0xC0) != 0x80) return 0;
  return length;
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

class Reader {
 public:
  Reader(std::string file, Faults& faults) : file_(std::move(file)), faults_(faults) {}

  Element element(const tinyxml2::XMLElement& xml) {
    Element element{.tag = xml.Name(), .where = at(xml.GetLineNum())};
    std::set<std::string> seen;
    for (const auto* a = xml.FirstAttribute(); a; a = a->Next()) {
      if (!seen.insert(a->Name()).second)
        fault(a->GetLineNum(), fmt::format("{} carries the attribute {} twice", element.tag, a->Name()));
      else
        element.attributes.push_back({a->Name(), a->Value(), at(a->GetLineNum())});
    }
    for (const auto* node = xml.FirstChild(); node; node = node->NextSibling()) child(element, *node);
    return element;
  }

  void fault(int line, std::string message) { faults_.push_back({at(line), std::move(message)}); }
  Location at(int line) const { return {file_, line}; }

 private:
  void child(Element& parent, const tinyxml2::XMLNode& node) {
    if (const auto* inner = node.ToElement()) {
      parent.children.push_back(element(*inner));
    } else if (const auto* text = node.ToText()) {
      if (!blank(text->Value()))
        fault(text->GetLineNum(),
              fmt::format("text '{}' inside {} has no meaning; values stand in attributes", shortened(text->Value()),
                          parent.tag));
    }
  }

  std::string file_;
  Faults& faults_;
};

/// A document type declaration could define entities that grow without bound; scenes need none.
void refuse_declarations(const tinyxml2::XMLDocument& xml, Reader& reader) {
  for (const auto* node = xml.FirstChild(); node; node = node->NextSibling())
    if (node->ToUnknown())
      reader.fault(node->GetLineNum(), "document type and entity declarations (<!…>) are not allowed in a scene");
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
                 fmt::format("namespace '{}' is not '{}'", shortened(declared->value), scene_namespace));
  std::erase_if(root.attributes, [](const Attribute& a) { return a.name.starts_with("xmlns"); });
}

std::string xml_problem(const tinyxml2::XMLDocument& xml) {
  using namespace tinyxml2;
  switch (xml.ErrorID()) {
    case XML_ERROR_EMPTY_DOCUMENT: return "the file is empty, but a scene starts with <msml>";
    case XML_ERROR_PARSING_ATTRIBUTE: return "malformed attribute: expected name=\"value\"";
    case XML_ERROR_MISMATCHED_ELEMENT: return fmt::format("a tag is not closed, or closed by another name");
    case XML_ERROR_PARSING_COMMENT: return "a comment <!-- is not closed by -->";
    case XML_ERROR_PARSING_CDATA: return "a CDATA section is not closed by ]]>";
    case XML_ERROR_PARSING_TEXT: return "text is not closed by a tag: the file ends too early";
    case XML_ERROR_PARSING_ELEMENT: return "malformed or unclosed tag: the file may end too early";
    case XML_ELEMENT_DEPTH_EXCEEDED: return "tags are nested too deeply";
    default: return std::string("not well-formed XML: ") + xml.ErrorName();
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
  if (text.size() > largest_file) {
    reader.fault(0, fmt::format("the file has {} MiB, more than the {} MiB allowed; put large data in files of their own",
                                text.size() >> 20, largest_file >> 20));
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
  refuse_declarations(xml, reader);
  if (!xml.RootElement()) {
    reader.fault(1, "the file holds no tag, but a scene starts with <msml>");
    return document;
  }
  document.root = reader.element(*xml.RootElement());
  for (const auto* second = xml.RootElement()->NextSiblingElement(); second; second = second->NextSiblingElement())
    reader.fault(second->GetLineNum(), fmt::format("<{}> stands after the end of the scene", second->Name()));
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
