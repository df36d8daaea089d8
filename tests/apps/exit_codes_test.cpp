// Every exit code of the program (NOTATION.md), also where the machine refuses something; and that what files and paths
// bring with them never acts on a terminal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "finger_scene.hpp"
#include "run_program.hpp"

namespace sinew::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// What a line of the shell ends with; `$SINEW` in it is the program.
Finished in_shell(const std::string& line, const Folder& folder) {
  const std::string out = (folder / "said.txt").string(), err = (folder / "complained.txt").string();
  const int status = std::system(("cd '" + folder.path().string() + "'; SINEW='" + program() + "'; ( " + line +
                                  " ) >'" + out + "' 2>'" + err + "'")
                                     .c_str());
  Finished done;
  if (WIFEXITED(status)) done.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) done.signal = WTERMSIG(status);
  done.out = read_file(out);
  done.err = read_file(err);
  return done;
}

struct Ending {
  std::string line;
  int code;
  std::string message;  ///< part of what is said on standard error
};

class ExitCode : public testing::TestWithParam<Ending> {};

TEST_P(ExitCode, IsTheDocumentedOneWithAMessage) {
  const Folder folder;
  write_file(folder / "meshes/finger.vtk", finger_mesh());
  write_file(folder / "finger.yaml", finger_scene);
  const Finished done = in_shell(GetParam().line, folder);
  EXPECT_EQ(done.code, GetParam().code) << said(done);
  EXPECT_THAT(done.err, HasSubstr(GetParam().message)) << said(done);
  EXPECT_FALSE(crashed(done)) << said(done);
}

const std::string kLongName = "$(printf %0300d 1)";  // names have at most 255 bytes
const std::string kLongPath = "$(for i in $(seq 60); do printf '%s' $(printf %0100d 1)/; done)";  // paths 4096
const std::string kFull = "standard output: cannot be written: No space left on device\n    free space there";

INSTANTIATE_TEST_SUITE_P(
    Of, ExitCode,
    testing::Values(Ending{"$SINEW check finger.yaml", 0, ""},
                    Ending{"$SINEW run finger.yaml -o out --set time.duration=20ms -q", 0, ""},
                    Ending{"$SINEW check " + kLongName, 2, "File name too long"},
                    Ending{"$SINEW run finger.yaml -q -o " + kLongName, 2, "File name too long"},
                    Ending{"$SINEW run finger.yaml -q -o " + kLongPath, 2, "File name too long"},
                    Ending{"$SINEW run " + kLongName + " -q -o out", 2, "File name too long"},
                    Ending{"$SINEW view " + kLongName, 2, "File name too long"},
                    Ending{"$SINEW view " + kLongPath, 2, "File name too long"},
                    Ending{"$SINEW export " + kLongName, 2, "File name too long"},
                    Ending{"$SINEW info " + kLongPath, 2, "File name too long"},
                    Ending{"$SINEW workspace finger.yaml -o " + kLongName, 2, ""},
                    Ending{"mkdir folder.vtk; $SINEW info folder.vtk", 2, "folder.vtk"},
                    Ending{"$SINEW info /proc/self/mem", 2, "/proc/self/mem"},
                    Ending{"ln -s /proc/self/mem mesh.vtk; $SINEW info mesh.vtk", 2, "mesh.vtk"},
                    Ending{"ln -s loop.vtk loop.vtk; $SINEW info loop.vtk", 2, "loop.vtk"},
                    Ending{"$SINEW check finger.yaml --set rods.cable.section.circle.radius=1e300", 2, "radius"},
                    Ending{"$SINEW check finger.yaml --set rods.cable.section.circle.radius=1e-300", 2, "radius"},
                    Ending{"$SINEW --help > /dev/full", 2, kFull}, Ending{"$SINEW run --help > /dev/full", 2, kFull},
                    Ending{"$SINEW --version > /dev/full", 2, kFull}, Ending{"$SINEW schema > /dev/full", 2, kFull},
                    Ending{"$SINEW info meshes/finger.vtk > /dev/full", 2, kFull},
                    Ending{"$SINEW check finger.yaml > /dev/full", 2, kFull},
                    Ending{"$SINEW run finger.yaml -o out --set time.duration=20ms > /dev/full", 2, kFull},
                    Ending{"$SINEW run finger.yaml -o out --set time.duration=20ms -q; $SINEW export out > /dev/full",
                           2, kFull},
                    Ending{"$SINEW schema | head -c 1; exit 0", 0, ""}));

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(ExitCodes, WithoutMemoryIsOneWithAMessage) {
  const Folder folder;
  write_file(folder / "meshes/finger.vtk", finger_mesh());
  write_file(folder / "finger.yaml", finger_scene);
  // At some limit the program starts and then finds no more: not at the same one on every machine.
  int refused = 0;
  for (int limit = 20'000; limit <= 100'000; limit += 10'000) {
    const Finished done =
        in_shell("ulimit -v " + std::to_string(limit) + "; exec $SINEW run finger.yaml -o out --force -q", folder);
    if (done.code == 127 || done.signal != 0) continue;  // the loader found none
    EXPECT_TRUE(done.code == 0 || done.code == 1) << said(done);
    if (done.code != 1) continue;
    EXPECT_THAT(done.err, HasSubstr("no memory")) << said(done);
    ++refused;
  }
  EXPECT_GT(refused, 0);
}
#endif

TEST(Terminal, GetsNoBytesOfFilesAndPathsThatActOnIt) {
  const Folder folder;
  const std::string colour = "\x1b[31m",
                    title =
                        "\xc2\x9b"
                        "2J",
                    turned = "\xe2\x80\xae";
  write_file(folder / "meshes/finger.vtk", finger_mesh());
  write_file(folder / "finger.yaml", finger_scene);
  write_file(folder / "groups.inp",
             "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*ELEMENT, TYPE=C3D4, ELSET=" + colour + "red" +
                 title + turned + "\n1, 1, 2, 3, 4\n");
  for (const std::string& line :
       {std::string("$SINEW info groups.inp"), "$SINEW info '" + colour + ".vtk'", "$SINEW '" + colour + "'",
        "$SINEW run finger.yaml --set '" + colour + "=1' -o out", "$SINEW check finger.yaml --" + turned + colour}) {
    const Finished done = in_shell(line, folder);
    for (const std::string& text : {done.out, done.err})
      EXPECT_THAT(text, AllOf(Not(HasSubstr("\x1b")), Not(HasSubstr("\xc2\x9b")), Not(HasSubstr(turned)))) << line;
    EXPECT_NE(done.out + done.err, "") << line;
  }
}

}  // namespace
}  // namespace sinew::test
