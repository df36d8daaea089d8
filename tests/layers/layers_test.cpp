// Keeps the layers one-way: reads the #include lines of src and apps and holds them against the table below. Also the
// small rules of the layout: telling names, #pragma once, files that one can read in one sitting.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace sinew {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Layers = std::map<std::string, std::set<std::string>>;

// Folder of src/sinew -> the folders it may include, besides itself. Nothing may include apps.
const Layers kMayInclude = {
    {"error", {}},
    {"lie", {}},
    {"threads", {}},
    {"linalg", {"threads"}},
    {"rod", {"lie", "linalg"}},
    {"solid", {"lie", "linalg"}},
    {"constraint", {"lie", "rod", "solid", "linalg"}},
    {"contact", {}},
    {"rigid", {"lie"}},
    {"solve", {"linalg", "threads"}},
    {"sim", {"error", "lie", "linalg", "rod", "solid", "rigid", "contact", "constraint", "solve", "threads"}},
    {"io", {"error", "solid", "sim"}},
    {"runs", {"error", "solid", "sim", "io", "threads"}},
    {"live", {"error", "solid", "sim", "io", "runs", "threads"}},
};

const std::set<std::string> kVagueNames = {"util",    "utils", "utilities", "common", "base",  "helper",
                                           "helpers", "misc",  "legacy",    "stuff",  "shared"};

constexpr std::size_t kMaxLines = 600;

struct SourceFile {
  std::string path;  // from the root of the repository, with slashes
  std::string text;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string listed(const std::set<std::string>& names) {
  return names.empty() ? "no other folder" : fmt::format("only {}", fmt::join(names, ", "));
}

struct Include {
  std::size_t line;
  bool quoted;
  std::string target;
};

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  std::vector<Include> includes;
  const std::vector<std::string> lines = lines_of(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::smatch match;
    if (std::regex_match(lines[i], match, pattern)) includes.push_back({i + 1, match[1] == "\"", match[2]});
  }
  return includes;
}

/// One message per broken rule: file, line, what is there, the rule. `path` is src/sinew/<layer>/...
std::vector<std::string> broken_arrows(const SourceFile& file, const Layers& may_include) {
  static const std::regex in_layer(R"(src/sinew/([^/]+)/.+)"), of_layer(R"(sinew/([^/]+)/.+)");
  std::smatch match;
  if (!std::regex_match(file.path, match, in_layer)) {
    return {fmt::format("{}: every file of src lies in src/sinew/<layer>/", file.path)};
  }
  const std::string layer = match[1];
  const auto allowed = may_include.find(layer);
  if (allowed == may_include.end()) {
    return {
        fmt::format("{}: folder {} is not in the table of tests/layers/layers_test.cpp; say there what it may include",
                    file.path, layer)};
  }
  std::vector<std::string> broken;
  for (const Include& include : includes_of(file.text)) {
    if (!include.quoted && include.target.rfind("sinew/", 0) != 0) continue;  // another library
    const std::string where = fmt::format("{}:{}: includes {}; ", file.path, include.line, include.target);
    if (!std::regex_match(include.target, match, of_layer)) {
      broken.push_back(where + "src includes its own files as \"sinew/<layer>/<file>\" and nothing of apps");
      continue;
    }
    const std::string target = match[1];
    if (target == layer || allowed->second.count(target)) continue;
    broken.push_back(where + fmt::format("{} may include {}", layer, listed(allowed->second)));
  }
  return broken;
}

bool says_nothing(const fs::path& path) {  // its last part; a folder on the way is an entry of its own
  const std::string name = path.filename().string();
  return kVagueNames.count(name.substr(0, name.find('.'))) > 0;
}

std::vector<std::string> untidy_file(const SourceFile& file) {
  std::vector<std::string> found;
  const std::vector<std::string> lines = lines_of(file.text);
  const bool header = fs::path(file.path).extension() == ".hpp";
  if (header && std::find(lines.begin(), lines.end(), "#pragma once") == lines.end()) {
    found.push_back(fmt::format("{}:1: every header has a line #pragma once", file.path));
  }
  if (lines.size() > kMaxLines) {
    found.push_back(fmt::format("{}:{}: {} lines; a file has {} at most: split it by what it does", file.path,
                                kMaxLines + 1, lines.size(), kMaxLines));
  }
  return found;
}

std::vector<SourceFile> sources_under(const std::vector<std::string>& folders) {
  const fs::path root = SINEW_SOURCE_DIR;
  std::vector<SourceFile> files;
  for (const std::string& folder : folders) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      const fs::path extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
      files.push_back({entry.path().lexically_relative(root).generic_string(), text.str()});
    }
  }
  std::sort(files.begin(), files.end(), [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

std::string all(const std::vector<std::string>& messages) { return fmt::format("{}", fmt::join(messages, "\n")); }

void append(std::vector<std::string>& messages, const std::vector<std::string>& more) {
  messages.insert(messages.end(), more.begin(), more.end());
}

TEST(Layers, every_include_follows_an_arrow_of_the_table) {
  std::vector<std::string> broken;
  std::size_t seen = 0;
  for (const SourceFile& file : sources_under({"src"})) {
    append(broken, broken_arrows(file, kMayInclude));
    for (const Include& include : includes_of(file.text)) seen += include.target.rfind("sinew/", 0) == 0;
  }
  EXPECT_GT(seen, 100u) << "the include lines were not found, so nothing was tested";
  EXPECT_THAT(broken, IsEmpty()) << all(broken);
}

TEST(Layers, every_included_file_of_ours_is_there) {
  std::vector<std::string> broken;
  const fs::path root = SINEW_SOURCE_DIR;
  for (const SourceFile& file : sources_under({"src", "apps"})) {
    for (const Include& include : includes_of(file.text)) {
      if (include.target.rfind("sinew/", 0) != 0) continue;
      if (fs::exists(root / "src" / include.target)) continue;
      if (file.path.rfind("apps/", 0) == 0 && fs::exists(root / "apps" / include.target)) continue;
      broken.push_back(fmt::format("{}:{}: there is no {}", file.path, include.line, include.target));
    }
  }
  EXPECT_THAT(broken, IsEmpty()) << all(broken);
}

TEST(Layers, the_table_has_one_line_per_folder_and_no_circle) {
  const fs::path layers = fs::path(SINEW_SOURCE_DIR) / "src/sinew";
  for (const fs::directory_entry& entry : fs::directory_iterator(layers)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(!entry.is_directory() || kMayInclude.count(name)) << name << " is not in the table";
  }
  Layers rest = kMayInclude;  // take away, again and again, what stands on nothing that is left
  const auto stands_free = [&rest](const Layers::value_type& layer) {
    return std::none_of(layer.second.begin(), layer.second.end(),
                        [&rest](const std::string& below) { return rest.count(below) > 0; });
  };
  for (auto free = std::find_if(rest.begin(), rest.end(), stands_free); free != rest.end();
       free = std::find_if(rest.begin(), rest.end(), stands_free)) {
    rest.erase(free);
  }
  EXPECT_THAT(rest, IsEmpty()) << "these go round in a circle";
  for (const auto& [layer, below] : kMayInclude) {
    EXPECT_TRUE(fs::is_directory(layers / layer)) << layer << " has no folder";
    for (const std::string& name : below) EXPECT_TRUE(kMayInclude.count(name)) << layer << " names " << name;
  }
}

TEST(Layers, no_file_or_folder_has_a_name_that_says_nothing) {
  std::vector<std::string> found;
  const fs::path root = SINEW_SOURCE_DIR;
  for (const char* folder : {"src", "apps"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!says_nothing(entry.path())) continue;
      found.push_back(fmt::format("{}: the name says nothing; name it after what it holds",
                                  entry.path().lexically_relative(root).generic_string()));
    }
  }
  EXPECT_THAT(found, IsEmpty()) << all(found);
}

TEST(Layers, headers_are_guarded_and_files_are_short) {
  std::vector<std::string> found;
  const std::vector<SourceFile> files = sources_under({"src", "apps", "tests"});
  EXPECT_GT(files.size(), 50u);
  for (const SourceFile& file : files) append(found, untidy_file(file));
  EXPECT_THAT(found, IsEmpty()) << all(found);
}

// The rules themselves, on files that break them.

TEST(LayerRules, an_arrow_upwards_is_named_with_file_line_and_rule) {
  const SourceFile file{"src/sinew/rod/rod.cpp", "#include <vector>\n\n  # include \"sinew/solid/body.hpp\"  // why\n"};
  EXPECT_THAT(broken_arrows(file, kMayInclude),
              ElementsAre("src/sinew/rod/rod.cpp:3: includes sinew/solid/body.hpp; rod may include only lie, linalg"));
}

TEST(LayerRules, arrows_downwards_and_other_libraries_are_fine) {
  const SourceFile file{
      "src/sinew/rod/rod.cpp",
      "#include \"sinew/rod/rod.hpp\"\n#include \"sinew/lie/rotation.hpp\"\n#include <Eigen/Dense>\n"};
  EXPECT_THAT(broken_arrows(file, kMayInclude), IsEmpty());
}

TEST(LayerRules, angle_brackets_relative_paths_and_apps_do_not_get_round_the_rule) {
  const auto broken = [](const std::string& line) {
    return broken_arrows({"src/sinew/lie/rotation.hpp", "#pragma once\n" + line}, kMayInclude);
  };
  EXPECT_THAT(broken("#include <sinew/io/fields.hpp>"), ElementsAre(HasSubstr("lie may include no other folder")));
  EXPECT_THAT(broken("#include \"../io/fields.hpp\""), ElementsAre(HasSubstr(":2: includes ../io/fields.hpp")));
  EXPECT_THAT(broken("#include \"sinew/commands.hpp\""), ElementsAre(HasSubstr("nothing of apps")));
}

TEST(LayerRules, a_folder_that_is_not_in_the_table_is_refused) {
  EXPECT_THAT(broken_arrows({"src/sinew/shell/shell.cpp", ""}, kMayInclude),
              ElementsAre(AllOf(HasSubstr("src/sinew/shell/shell.cpp"), HasSubstr("folder shell"))));
  EXPECT_THAT(broken_arrows({"src/sinew/loose.cpp", ""}, kMayInclude), ElementsAre(HasSubstr("src/sinew/<layer>/")));
}

TEST(LayerRules, vague_names_missing_guards_and_long_files_are_found) {
  EXPECT_TRUE(says_nothing("src/sinew/rod/utils.hpp"));
  EXPECT_TRUE(says_nothing("src/sinew/common"));
  EXPECT_FALSE(says_nothing("src/sinew/rod/baseline.hpp"));
  EXPECT_THAT(untidy_file({"a.hpp", "int a;\n"}), ElementsAre(HasSubstr("a.hpp:1: every header")));
  EXPECT_THAT(untidy_file({"a.hpp", "// #pragma once\n"}), ElementsAre(HasSubstr("a.hpp:1: every header")));
  EXPECT_THAT(untidy_file({"a.cpp", std::string(600, '\n')}), IsEmpty());
  EXPECT_THAT(untidy_file({"a.cpp", std::string(601, '\n')}), ElementsAre(HasSubstr("a.cpp:601: 601 lines")));
}

}  // namespace
}  // namespace sinew
