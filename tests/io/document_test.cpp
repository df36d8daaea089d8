#include "sinew/io/document.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "sinew/error/input_error.hpp"

namespace sinew::io {
namespace {

InputFault document_fault(const std::string& text) {
  try {
    const Node root = parse_document(text, "a.yaml");
    ADD_FAILURE() << "read: " << show(root);
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().file, "a.yaml");
    EXPECT_FALSE(error.fault().remedy.empty());
    return error.fault();
  }
  return {};
}

InputFault fault_of_set(const std::string& text, const std::string& assignment) {
  Node root = parse_document(text, "a.yaml");
  try {
    set_value(root, assignment);
    ADD_FAILURE() << "accepted: " << write_document(root);
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().file, "--set");
    EXPECT_EQ(error.fault().line, 0);
    return error.fault();
  }
  return {};
}

std::string repeated(const std::string& part, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += part;
  return all;
}

bool same(const Node& a, const Node& b) {
  if (a.kind != b.kind || a.text != b.text || a.items.size() != b.items.size() || a.entries.size() != b.entries.size())
    return false;
  for (std::size_t i = 0; i < a.items.size(); ++i) {
    if (!same(a.items[i], b.items[i])) return false;
  }
  for (std::size_t i = 0; i < a.entries.size(); ++i) {
    if (a.entries[i].key != b.entries[i].key || !same(a.entries[i].value, b.entries[i].value)) return false;
  }
  return true;
}

TEST(Document, KeepsOrderAndLines) {
  const Node root = parse_document("# comment\nb: 1\na:\n  - x\n  - [2,\n     3]\nc: {d: 'q', e: ~}\nf:\n", "a.yaml");
  ASSERT_EQ(root.kind, Node::Kind::map);
  ASSERT_EQ(root.entries.size(), 4u);
  EXPECT_EQ(root.entries[0].key, "b");
  EXPECT_EQ(root.entries[0].value.text, "1");
  EXPECT_EQ(root.entries[0].line, 2);
  const Node& a = root.entries[1].value;
  ASSERT_EQ(a.kind, Node::Kind::list);
  EXPECT_EQ(root.entries[1].line, 3);
  EXPECT_EQ(line_of(root.entries[1]), 3);
  EXPECT_EQ(a.items[0].line, 4);
  EXPECT_EQ(a.items[1].items[1].line, 6);
  const Node& c = root.entries[2].value;
  EXPECT_EQ(c.entries[0].value.text, "q");
  EXPECT_EQ(c.entries[1].value.kind, Node::Kind::empty);
  EXPECT_EQ(c.entries[1].line, 7);
  EXPECT_EQ(root.entries[3].value.kind, Node::Kind::empty);
  EXPECT_EQ(line_of(root.entries[3]), 8);
}

struct Broken {
  std::string text;
  int line;
  std::string rule;
};

TEST(Document, RefusesWhatIsNotASmallPlainDocument) {
  const std::vector<Broken> all = {
      {"", 0, "is empty"},
      {"# only a comment\n", 0, "is empty"},
      {"---\n...\n", 0, "is empty"},
      {"a: 1\nb: &x 2\n", 2, "anchors and aliases are not supported"},
      {"a: &x\n  b: 1\nc: *x\n", 1, "anchors and aliases are not supported"},
      {"a: *x\n", 1, "not valid YAML"},
      {"a: 1\nb: !!str 2\n", 2, "tags are not supported"},
      {"a: !python/object {x: 1}\n", 1, "tags are not supported"},
      {"a: 1\nb: 2\na: 3\n", 3, "is given twice"},
      {"x: {a: 1, a: 2}\n", 1, "is given twice"},
      {"a: 1\n---\nb: 2\n", 2, "more than one document"},
      {"a: 1\nb: [1,\n  2\n", 3, "not valid YAML"},
      {"a: 1\n  b: 2\n", 2, "not valid YAML"},
      {"a: 'open\n", 1, "that is never closed"},
      {"a: 1\nb: \"open\nc: 2\n", 2, "that is never closed"},
      {"a: 1\n'b: 2\n", 1, "that is never closed"},
      {"a: 1\n\tb: 2\n", 2, "tab begins this line"},
      {"a: 1\n]\n", 2, "not valid YAML"},
      {"? [a, b]\n: 1\n", 1, "cannot be a key"},
      {"{a: 1}: 1\n", 1, "cannot be a key"},
      {": 1\n", 1, "a key is missing"},
      {",", 1, "more than one document"},
      {"a: 1\nb: \xFF\n", 2, "not text in UTF-8"},
      {"a: \xC0\x80\n", 1, "not text in UTF-8"},
      {"a: \xED\xA0\x80\n", 1, "not text in UTF-8"},
      {"a: \xF4\x90\x80\x80\n", 1, "not text in UTF-8"},
      {"a: \xE0\x80\x80\n", 1, "not text in UTF-8"},
      {"a: \xF0\x80\x80\x80\n", 1, "not text in UTF-8"},
      {"a: \xE2\x82", 1, "not text in UTF-8"},
      {std::string("a: 1\0b: 2", 9), 1, "not text in UTF-8"},
      {"a: 1\n\x04"
       "b: 2",
       2, "not text in UTF-8"},
      {"\xFF\xFE"
       "a",
       1, "not text in UTF-8"},
      {repeated("[", 33) + repeated("]", 33), 1, "nested more than 32 deep"},
      {repeated("{a: ", 33) + repeated("}", 33), 1, "nested more than 32 deep"},
      {repeated("- ", 40) + "x", 1, "nested more than 32 deep"},
      {std::string(largest_document + 1, 'x'), 0, "is larger than 1 MiB"},
  };
  for (const Broken& broken : all) {
    const InputFault fault = document_fault(broken.text);
    EXPECT_NE(fault.rule.find(broken.rule), std::string::npos) << show(broken.text) << "\n" << to_string(fault);
    EXPECT_EQ(fault.line, broken.line) << show(broken.text) << "\n" << to_string(fault);
  }
}

TEST(Document, AcceptsTheLimitsAndForeignText) {
  EXPECT_EQ(parse_document(repeated("[", 32) + repeated("]", 32), "a").kind, Node::Kind::list);
  EXPECT_EQ(parse_document("a: " + std::string(largest_document - 3, 'x'), "a").kind, Node::Kind::map);
  EXPECT_EQ(parse_document("\xEF\xBB\xBFt: \xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80\n", "a").entries[0].key, "t");
  EXPECT_EQ(parse_document("a: 1\r\nb: 2\r\n", "a").entries[1].line, 2);
}

TEST(Document, GarbageOfAnySizeIsRefusedAtOnce) {
  for (const char* part : {"[", "{", "- ", "? ", "a: ",   "[{",  "!a ", "&a ",  "*a ",    "'",    "\"",  "{a: ", "[a, ",
                           ",", "]", ": ", "%",  "---\n", "|\n", "\t",  "- ? ", "[[] , ", "\xC3", "a\n", "? - "}) {
    const std::size_t size = std::string(part).size();
    for (const std::size_t bytes : {largest_document, std::size_t{10'000'000}}) {
      const auto start = std::chrono::steady_clock::now();
      try {
        parse_document(repeated(part, bytes / size), "a.yaml");
      } catch (const InputError&) {
      }
      EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10)) << part;
    }
  }
}

TEST(Document, ReadsFilesUpToTheLimitOnly) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "sinew_document_test";
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / "a.yaml";
  std::ofstream(file, std::ios::binary) << "a: 1\r\n";
  EXPECT_EQ(read_text(file), "a: 1\r\n");
  std::ofstream(file, std::ios::binary) << std::string(10'000'000, '\xFF');
  EXPECT_THROW(read_text(file), InputError);
  EXPECT_THROW(read_text(folder), InputError);
  EXPECT_THROW(read_text(folder / "missing.yaml"), InputError);
  std::filesystem::remove_all(folder);
}

TEST(Document, WhatIsWrittenReadsTheSame) {
  for (const std::string text :
       {"a: 1\nb: [1, 2, [3, ~]]\nc: {d: {e: x}}\nf: [{g: 1, h: {}}, {i: []}]\n", "[[], [{a: 1}], {}, [[{b: 2}]]]", "x",
        "a: ''\nb: 'null'\nc: null\nd: '~'\ne: '- x'\nf: '# no'\ng: ' pad '\nt1: 'pad '\nh: \"\\t\\n\\e\\\\\\\"\"\ni: "
        "'a: b'\nj: "
        "'---'\n"
        "k: '...'\nl: \"\\u00e9\\U0001F600\\x85\"\nm: -x\nn: '-'\no: '[1]'\np: '&a'\nq: '*a'\nr: '!a'\ns: '%'\nt: '? "
        "'\n",
        "'a b: c': 1\n'': 2\n'null': 3\n"}) {
    const Node root = parse_document(text, "a.yaml");
    const std::string written = write_document(root);
    EXPECT_TRUE(same(root, parse_document(written, "b.yaml"))) << written;
  }
}

TEST(Document, MessagesShowShortPrintableValues) {
  EXPECT_EQ(show(parse_document("[1, {a: 'x: y'}]", "a")), "[1, {a: \"x: y\"}]");
  EXPECT_EQ(show(parse_document("\"a\\e[31mb\"", "a")), "a?[31mb");
  EXPECT_EQ(show(std::string(100, 'x'), 10), "xxxxxxxxxx...");
  EXPECT_EQ(show(std::string("123456789\xC3\xA9"
                             "abc"),
                 10),
            "123456789...");
  EXPECT_LT(show(parse_document("[" + repeated("1, ", 100000) + "]", "a")).size(), 70u);
}

TEST(Override, ReplacesAndAdds) {
  Node root = parse_document("a: {b: 1}\nl: [{c: 1}, {c: 2}]\ne:\n", "a.yaml");
  set_value(root, "a.b=12 mm");
  set_value(root, "l.1.c=[1, 2]");
  set_value(root, "n.m.k=x=y");
  set_value(root, "e.f=3");
  EXPECT_EQ(write_document(root),
            "a:\n  b: 12 mm\nl:\n  -\n    c: 1\n  -\n    c: [1, 2]\ne:\n  f: 3\nn:\n  m:\n    k: \"x=y\"\n");
  EXPECT_EQ(root.entries[0].value.entries[0].value.line, 0);
  EXPECT_EQ(root.entries[0].line, 1);
}

TEST(Override, Refuses) {
  const std::string text = "solids: {finger: {mesh: a}}\nl: [1, 2]\n";
  EXPECT_EQ(fault_of_set(text, "solids.finger.mesh").rule, "must be path=value");
  EXPECT_EQ(fault_of_set(text, "=1").rule, "must be path=value");
  EXPECT_EQ(fault_of_set(text, "solids..mesh=1").rule, "must be path=value");
  EXPECT_EQ(fault_of_set(text, repeated("a.", 100) + "a=1").rule, "must be path=value");
  EXPECT_EQ(fault_of_set(text, "title= ").rule, "is given no value");
  EXPECT_EQ(fault_of_set(text, "title=#c").rule, "is empty");
  EXPECT_EQ(fault_of_set(text, "title=[1").path, "title");
  EXPECT_EQ(fault_of_set(text, "l.2=1").remedy, "the list has elements 0 to 1");
  EXPECT_EQ(fault_of_set(text, "l.x=1").rule, "has no element 'x'");
  EXPECT_EQ(fault_of_set(text, "l.0.x=1").rule, "does not exist: l.0 is a single value, not a map");
  const InputFault fault = fault_of_set(text, "solids.fingr.mesh=b");
  EXPECT_EQ(fault.path, "solids.fingr");
  EXPECT_EQ(fault.rule, "does not exist in this scene");
  EXPECT_EQ(fault.remedy, "did you mean `finger`? solids holds finger");
}

}  // namespace
}  // namespace sinew::io
