// SPDX-License-Identifier: GPL-3.0-or-later
// `insula devices`: list, live view, calibration and force test, with stand-ins on the table.
#include "haptic_server/device_tool/device_tool.h"

#include <fstream>
#include <sstream>

#include "core/base/input_error.h"
#include "haptic_server/device_tool/calibrate.h"
#include "haptic_server/problem_for_test.h"
#include "tests/devices/device_bench.h"
#include "tests/devices/haply_stand_in.h"

namespace insula {
namespace {

class DeviceTool : public testing::DeviceBench {
 protected:
  DeviceTool() {
    options.out = &out;
    options.input = -1;
    options.stop = &stop;
    options.device = "touch:Left Device";
  }
  bool says(const std::string& text) const { return out.str().find(text) != std::string::npos; }
  /// Presses button 1 of the first arm for a moment.
  void press() {
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    arm(0).buttons = 1;
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    arm(0).buttons = 0;
  }
  std::ostringstream out;
  std::atomic<bool> stop{false};
  DeviceToolOptions options;
};

TEST_F(DeviceTool, ListsWhatIsThereAndHowToGetTheRest) {
  std::filesystem::create_directories(folder + "/config");
  for (const char* name : {"Left Device", "Right Device", "Lost Device"})
    std::ofstream(folder + "/config/" + name + ".config") << "";
  DeviceCalibration c;
  save_calibration("forcedimension:1002", c);
  testing::HaplyStandIn service(testing::two_arms());
  ::setenv("INSULA_HAPLY_URL", service.url().c_str(), 1);
  ::setenv("INSULA_LIBSPNAV", "/nowhere/libspnav.so", 1);
  EXPECT_EQ(list_devices(out), 0);
  EXPECT_TRUE(says("touch:Left Device            Touch, serial number 1001\n")) << out.str();
  EXPECT_TRUE(says("touch:Right Device"));
  EXPECT_FALSE(says("Lost Device"));
  EXPECT_TRUE(says("forcedimension:1001          Touch\n"));
  EXPECT_TRUE(says("forcedimension:1002          Touch, calibrated\n"));
  EXPECT_TRUE(says("haply:04BA                   inverse3, right hand, with grip 61548\n"));
  EXPECT_TRUE(says("haply:049D                   inverse3, left hand"));
  EXPECT_TRUE(says("not usable: /nowhere/libspnav.so: cannot open"));
  EXPECT_TRUE(says("to get it: sudo apt install spacenavd libspnav0\n"));
  EXPECT_EQ(arm(0).open, 0);  // nothing is left open
}

TEST_F(DeviceTool, ShowsADeviceLive) {
  options.seconds = 0.25;
  put(arm(0).p, 12.34, 0, 0);
  EXPECT_EQ(show_device(options), 0);
  EXPECT_TRUE(says("touch:Left Device: up to 3.3 N")) << out.str();
  EXPECT_TRUE(says("right    12.3  away"));
  options.device = "touch:Nobody";
  EXPECT_EQ(show_device(options), 1);
  EXPECT_TRUE(says("error: touch:\"Nobody\" is not there"));
  options.device = "tuch";
  EXPECT_THROW(show_device(options), InputError);
}

TEST_F(DeviceTool, CalibratesByFourPlaces) {
  std::filesystem::create_directories(calibration_folder());
  std::ofstream(calibration_file("touch:Left Device"))
      << "broken";  // an old calibration that is invalid does not prevent a new one
  int status = -1;
  std::thread tool([&] {
    try {
      status = calibrate_device(options);
    } catch (const InputError& e) {
      out << e.what();
    }
  });
  testing::wait_for([&] { return arm(0).frames > 20; });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const double places[4][3] = {
      {10, 20, 30}, {10, 22, 90}, {60, 20, 33}, {12, 70, 30}};  // mm; right is +z, away is +x, up is +y
  for (const auto& p : places) {
    put(arm(0).p, p[0], p[1], p[2]);
    press();
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
  }
  tool.join();
  ASSERT_EQ(status, 0) << out.str();
  const DeviceCalibration c = load_calibration("touch:Left Device", {});
  EXPECT_NEAR((c.rest.p - Vec3(0.010, 0.020, 0.030)).norm(), 0, 1e-9);
  Mat3 ideal;
  ideal << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  EXPECT_LT((c.axes - ideal).norm(), 0.15);
  EXPECT_TRUE(says("saved in " + calibration_file("touch:Left Device").string()));
}

TEST_F(DeviceTool, ACalibrationWithoutAnswersChangesNothing) {
  options.patience_s = 0.2;
  EXPECT_EQ(calibrate_device(options), 1);
  EXPECT_FALSE(std::filesystem::exists(calibration_file("touch:Left Device")));
  EXPECT_TRUE(says("no answer; nothing was changed"));
  options.device = "mouse";
  EXPECT_EQ(calibrate_device(options), 0);
}

TEST_F(DeviceTool, WaysThatCannotBeAreRefused) {
  const Pose rest{Vec3(0, -0.1, 0.1), Quat::Identity()};
  const auto fit = [&](const Vec3& r, const Vec3& a, const Vec3& u) {
    return fit_calibration(rest, rest.p + r, rest.p + a, rest.p + u, 1);
  };
  EXPECT_TRUE(fit({0.05, 0, 0}, {0, 0.05, 0}, {0, 0, 0.05}).axes.isIdentity(1e-12));
  EXPECT_THROW(fit({0.01, 0, 0}, {0, 0.05, 0}, {0, 0, 0.05}), InputError);   // too short
  EXPECT_THROW(fit({0.05, 0, 0}, {0.05, 0, 0}, {0, 0, 0.05}), InputError);   // the same twice
  EXPECT_THROW(fit({-0.05, 0, 0}, {0, 0.05, 0}, {0, 0, 0.05}), InputError);  // left taken for right: a mirror
  EXPECT_THROW(fit({0.05, 0, 0}, {std::nan(""), 0, 0}, {0, 0, 0.05}), InputError);
  testing::Random random(3);
  for (int k = 0; k < 200; ++k) {  // any orientation of a device, moved by an inexact hand
    const Mat3 turn = from_rotation_vector(random.vector(2)).toRotationMatrix();
    Mat3 strokes = 0.05 * turn;  // columns: the person's axes in the device's frame
    for (int i = 0; i < 3; ++i) strokes.col(i) += random.vector(0.008);
    const DeviceCalibration c = fit(strokes.col(0), strokes.col(1), strokes.col(2));
    ASSERT_EQ(calibration_error(c), "");
    ASSERT_LT(rotation_vector(Quat(c.axes * turn)).norm(), 0.25);
  }
}

TEST_F(DeviceTool, TheForceTestStartsGentlyAndStaysWithinItsForce) {
  options.assume_yes = true;
  options.newtons = 0.5;
  std::atomic<bool> done{false};
  double strongest = 0, steepest = 0;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  std::thread watcher([&] {
    Vec3 last = Vec3::Zero();
    auto then =
        std::chrono::steady_clock::now();  // before the last look: a slope is never taken for steeper than it was
    while (!done) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      const auto before = std::chrono::steady_clock::now();
      const Vec3 now = force(0);
      const auto t = std::chrono::steady_clock::now();
      strongest = std::max(strongest, now.norm());
      steepest = std::max(steepest, (now - last).norm() / (std::chrono::duration<double>(t - then).count() + 0.02));
      low = low.cwiseMin(now);
      high = high.cwiseMax(now);
      last = now;
      then = before;
    }
  });
  EXPECT_EQ(test_device_force(options), 0) << out.str();
  done = true;
  watcher.join();
  EXPECT_LE(strongest, 0.5 + 1e-9);
  EXPECT_LT(steepest, 5.5);  // N/s, seen through another thread's clock
  EXPECT_GT(high.minCoeff(), 0.45);
  EXPECT_LT(low.maxCoeff(), -0.45);
  EXPECT_EQ(force(0), Vec3(0, 0, 0));
  EXPECT_TRUE(says("the force test is done"));
}

TEST_F(DeviceTool, TheForceTestEndsWhenSomethingIsWrong) {
  options.assume_yes = true;
  const auto run = [&](const std::function<void()>& meanwhile) {
    std::thread later([&] {
      testing::wait_for([&] { return force(0).norm() > 0.05; });
      meanwhile();
    });
    const int status = test_device_force(options);
    later.join();
    return status;
  };
  EXPECT_EQ(run([&] { put(arm(0).p, 100, 0, 0); }), 1);
  EXPECT_TRUE(says("ended: it ran away from the hand")) << out.str();
  EXPECT_EQ(run([&] { arm(0).buttons = 1; }), 1);
  EXPECT_TRUE(says("ended: its button was pressed")) << out.str();
  arm(0).buttons = 0;
  EXPECT_EQ(run([&] { arm(0).plugged = 0; }), 1);
  EXPECT_TRUE(says("ended: the device was lost")) << out.str();
  arm(0).plugged = 1;
  EXPECT_EQ(run([&] { stop = true; }), 1);
  EXPECT_TRUE(says("ended: it was told to stop")) << out.str();
  stop = false;
  EXPECT_EQ(force(0), Vec3(0, 0, 0));
  options.newtons = 9;
  EXPECT_EQ(test_device_force(options), 2);
  options.device = "spacemouse";
  EXPECT_EQ(test_device_force(options), 2);
}

}  // namespace
}  // namespace insula
