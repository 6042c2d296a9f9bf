#!/usr/bin/env python3
"""Fault campaign: programs are killed, disks fail, clocks jump. Afterwards the same command must finish its work.

    python3 tests/campaign/faults.py build/release/bin                # 200 kills and all other faults
    python3 tests/campaign/faults.py build/release/bin --kills 1000   # more kills
    python3 tests/campaign/faults.py build/release/bin --short        # about 20 s, a test of ctest

Rules that are checked after each fault:
- A result file under its final name is complete: it has the bytes of an undisturbed run.
- A program that could not do its work ends with its documented exit code and a message, and leaves no temporary file.
- The same command, repeated without a fault, gives the bytes of an undisturbed run and no other files.

The exit code is 1 if a rule is broken, and 77 if the machine lacks a C compiler."""
import argparse
import errno
import hashlib
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
LIMIT_S = 300  # a command that takes longer hangs
SHORT_SCENARIO = """\
duration: 300 s
network: {approach: {length: 300 m}}
signal: {first_green: 60 s, green: 30 s}
demand: {vehicles: 20}
populations: [CDG, CTG-Ref]
measure: {green: [5 s, 10 s]}
"""
SWEEP = """\
scenario: short.yaml
axes:
- {name: hesitation, path: driver.free_drive.hesitation, values: [0 s, 0.5 s, 1 s]}
repetitions: 6
"""
TIMING_SWEEP = """\
scenario: {source}/scenarios/calibration.yaml
axes:
- {{name: green, path: signal.green, values: [10 s, 20 s]}}
- {{name: population, populations: [CTG-Ref, CDG]}}
"""
# Files whose bytes depend on the machine, the time or the order of the work. Only their existence is compared.
VARYING = (".sqlite", ".png", "times.csv", "index.html", "job.json")


class Campaign:
    def __init__(self, bin_folder, work, seed):
        self.bin = Path(bin_folder).resolve()
        self.work = work
        self.draw = random.Random(seed)
        self.failures = []
        self.counts = Counter()
        self.number = 0
        self.no_gnuplot = work / "path"  # programs find everything but gnuplot here
        self.no_gnuplot.mkdir()
        (work / "short.yaml").write_text(SHORT_SCENARIO)
        (work / "sweep.yaml").write_text(SWEEP)
        (work / "timing.yaml").write_text(TIMING_SWEEP.format(source=SOURCE))

    def fail(self, text):
        self.failures.append(text)
        print(f"FAILED: {text}", flush=True)

    def folder(self):
        self.number += 1
        return self.work / f"case_{self.number}"

    def program(self, name):
        return str(self.bin / f"stopline-{name}")


class Work:
    """A command whose results go into one folder."""

    def __init__(self, campaign, name, arguments, figures=False, failed_code=2):
        self.campaign = campaign
        self.name = name
        self.arguments = arguments
        self.environment = dict(os.environ)
        if not figures:
            self.environment["PATH"] = str(campaign.no_gnuplot)
        self.failed_code = failed_code
        self.expected = None
        self.whole_s = 0.0

    def command(self, folder):
        return [argument.replace("FOLDER", str(folder)) for argument in self.arguments]

    def start(self, folder, **environment):
        return subprocess.Popen(self.command(folder), cwd=self.campaign.work, stdin=subprocess.DEVNULL,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                env={**self.environment, **environment})

    def run(self, folder, **environment):
        process = self.start(folder, **environment)
        try:
            _, error = process.communicate(timeout=LIMIT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            _, error = process.communicate()
            self.campaign.fail(f"{self.name}: hangs for {LIMIT_S} s")
        return process.returncode, error

    def reference(self):
        """Runs the command undisturbed, once."""
        if self.expected is not None:
            return
        folder = self.campaign.folder()
        begin = time.monotonic()
        code, error = self.run(folder)
        self.whole_s = time.monotonic() - begin
        if code != 0:
            raise SystemExit(f"{self.name}: the undisturbed run ends with exit code {code}: {error}")
        self.expected = snapshot(folder)
        shutil.rmtree(folder)

    def check_partial(self, folder, case):
        """Checks that each result under its final name is complete."""
        for name, content in snapshot(folder).items():
            if is_temporary(name) or content is None:
                continue
            if name in self.expected and content != self.expected[name]:
                self.campaign.fail(f"{self.name}, {case}: {name} is not complete")

    def check_finished(self, folder, case):
        """Repeats the command without a fault and compares all files with those of the undisturbed run."""
        code, error = self.run(folder)
        if code != 0:
            self.campaign.fail(f"{self.name}, {case}: the repeated command ends with exit code {code}: {error}")
        found = snapshot(folder)
        for name in sorted(set(found) | set(self.expected)):
            if name not in found:
                self.campaign.fail(f"{self.name}, {case}: {name} is missing")
            elif name not in self.expected:
                self.campaign.fail(f"{self.name}, {case}: {name} is left over")
            elif found[name] != self.expected[name]:
                self.campaign.fail(f"{self.name}, {case}: {name} differs from that of the undisturbed run")
        shutil.rmtree(folder, ignore_errors=True)


def is_temporary(name):
    return ".part" in name or name.endswith(("-wal", "-journal", "-shm"))


def snapshot(folder):
    """Returns a hash of the content of each file below the folder; None for files that may vary."""
    files = {}
    for path in folder.rglob("*") if folder.exists() else []:
        name = str(path.relative_to(folder))
        if path.is_file():
            varies = is_temporary(name) or name.endswith(VARYING)
            try:
                files[name] = None if varies else hashlib.sha256(path.read_bytes()).hexdigest()
            except FileNotFoundError:
                pass
    return files


def temporary_files(folder):
    return [name for name in snapshot(folder) if ".part" in name]


def works(campaign):
    program = campaign.program
    sweep = [program("sweep"), "sweep.yaml", "--output", "FOLDER", "--threads", "2"]
    return {
        "run": Work(campaign, "run", [program("run"), "short.yaml", "--output", "FOLDER", "--trajectories", "--record",
                                      "FOLDER/run.rec", "--fcd", "FOLDER/fcd.xml.gz", "--tripinfo",
                                      "FOLDER/trips.xml.zst"]),
        "sweep": Work(campaign, "sweep", sweep),
        "sweep with figures": Work(campaign, "sweep with figures", sweep, figures=True),
        "calibration": Work(campaign, "calibration", [program("calibrate"), "timing.yaml", "--step", "I", "--starts",
                                                      "1", "--evaluations-per-start", "10", "--evaluations", "10",
                                                      "--output", "FOLDER"]),
        "scorecard": Work(campaign, "scorecard", [program("scorecard"), "--section", "III", "--output", "FOLDER"]),
        "report": Work(campaign, "report", [program("reproduce"), "--section", "III", "--quick", "--output", "FOLDER"],
                       figures=True, failed_code=1),
    }


def kill_at_random(campaign, work, kills, signals=(signal.SIGKILL,)):
    """Ends the program at random moments, some times in the same folder, then lets it finish."""
    work.reference()
    done = 0
    while done < kills:
        folder = campaign.folder()
        for _ in range(campaign.draw.randint(1, 4)):
            sent = campaign.draw.choice(signals)
            process = work.start(folder)
            time.sleep(campaign.draw.uniform(0.0, 1.1 * work.whole_s))
            process.send_signal(sent)
            _, error = process.communicate()
            case = f"{sent.name} {done + 1}"
            if process.returncode == -signal.SIGKILL and sent == signal.SIGKILL:
                done += 1
            elif sent != signal.SIGKILL and process.returncode in (128 + sent, -sent):  # -sent: before the handler
                done += 1
                if temporary_files(folder):
                    campaign.fail(f"{work.name}, {case}: temporary files are left: {temporary_files(folder)}")
            elif process.returncode != 0:
                campaign.fail(f"{work.name}, {case}: exit code {process.returncode}: {error}")
            work.check_partial(folder, case)
            if done >= kills:
                break
        if signal.SIGKILL in signals:
            time.sleep(0.3)  # programs that the killed one has started, such as gnuplot, end by themselves
        work.check_finished(folder, f"after {done} {'/'.join(s.name for s in signals)}")
    campaign.counts[f"{'/'.join(s.name for s in signals)}: {work.name}"] += done


def fail_calls(campaign, work, shim, cases):
    """Lets calls of the operating system fail from a random one on."""
    work.reference()
    faults = [("write", errno.ENOSPC), ("write", errno.EIO), ("write", errno.EDQUOT), ("sync", errno.EIO),
              ("sync", errno.ENOSPC), ("rename", errno.EIO), ("open", errno.EROFS), ("open", errno.ENOSPC),
              ("open", errno.EMFILE), ("short", 0)]
    for k in range(cases):
        call, error_number = faults[k % len(faults)]
        folder = campaign.folder()
        folder.mkdir()
        mark = campaign.work / "mark"
        mark.unlink(missing_ok=True)
        environment = {"LD_PRELOAD": str(shim), "FAULT_FOLDER": str(folder), "FAULT_CALL": call,
                       "FAULT_ERROR": str(error_number), "FAULT_MARK": str(mark),
                       "FAULT_AT": str(int(2 ** campaign.draw.uniform(0.0, 6.0)))}
        if campaign.draw.random() < 0.5:
            environment["FAULT_ONCE"] = "1"
        code, error = work.run(folder, **environment)
        name = "short write" if call == "short" else f"{call} fails with {errno.errorcode[error_number]}"
        case = f"{name} at {environment['FAULT_AT']}{' once' if 'FAULT_ONCE' in environment else ''}"
        happened = mark.exists()
        allowed = {0, work.failed_code} if happened and call != "short" else {0}
        if code not in allowed:
            campaign.fail(f"{work.name}, {case}: exit code {code}: {error}")
        if code != 0 and ("internal error" in error or not error.strip()):
            campaign.fail(f"{work.name}, {case}: unclear message: {error}")
        if code != 0 and temporary_files(folder):
            campaign.fail(f"{work.name}, {case}: temporary files are left: {temporary_files(folder)}")
        work.check_partial(folder, case)
        work.check_finished(folder, f"after: {case}")
        if happened:
            campaign.counts[f"{name}: {work.name}"] += 1


def fill_disks(campaign, work, cases):
    """Uses small file systems in memory, with few bytes or few files. Needs the right to mount."""
    work.reference()
    for k in range(cases):
        folder = campaign.folder()
        folder.mkdir()
        option = campaign.draw.choice([f"size={campaign.draw.randint(1, 60) * 4}k", "nr_inodes=%d" %
                                       campaign.draw.randint(1, 8)])
        if subprocess.run(["mount", "-t", "tmpfs", "-o", option, "tmpfs", folder], capture_output=True).returncode:
            print("  small file systems cannot be mounted here; left out")
            return
        try:
            code, error = work.run(folder)
            case = f"disk with {option}"
            if code not in (0, work.failed_code):
                campaign.fail(f"{work.name}, {case}: exit code {code}: {error}")
            if code != 0 and ("internal error" in error or not error.strip()):
                campaign.fail(f"{work.name}, {case}: unclear message: {error}")
            if code != 0 and temporary_files(folder):
                campaign.fail(f"{work.name}, {case}: temporary files are left: {temporary_files(folder)}")
            work.check_partial(folder, case)
            subprocess.run(["mount", "-o", "remount,size=100m,nr_inodes=10000", folder], check=True)
            code, error = work.run(folder)
            if code != 0 or snapshot(folder) != work.expected:
                campaign.fail(f"{work.name}, after {case}: exit code {code} or other files: {error}")
        finally:
            subprocess.run(["umount", folder], check=True)
        campaign.counts[f"full disk: {work.name}"] += 1


def use_read_only_folder(campaign, work):
    """The folder is read-only for all users but root."""
    if os.getuid() == 0:
        print("  root can write into read-only folders; left out (open fails with EROFS instead)")
        return
    work.reference()
    folder = campaign.folder()
    folder.mkdir(mode=0o555)
    code, error = work.run(folder)
    if code != 2 or str(folder) not in error:
        campaign.fail(f"{work.name}, read-only folder: exit code {code}: {error}")
    folder.chmod(0o755)
    work.check_finished(folder, "after a read-only folder")
    campaign.counts["read-only folder"] += 1


def share_a_store(campaign, work, cases):
    """Starts two programs on one store at the same time. One of them may be refused; the result is the same."""
    work.reference()
    for _ in range(cases):
        folder = campaign.folder()
        folder.mkdir()
        both = [work.start(folder)]
        time.sleep(campaign.draw.uniform(0.0, 0.5 * work.whole_s))
        both.append(work.start(folder))
        ends = [process.communicate()[1] for process in both]
        for process, error in zip(both, ends):
            if process.returncode != 0 and not (process.returncode == 2 and "another program has this store open" in error):
                campaign.fail(f"{work.name}, two programs: exit code {process.returncode}: {error}")
        if all(process.returncode for process in both):
            campaign.fail(f"{work.name}, two programs: both are refused: {ends}")
        work.check_finished(folder, "two programs")
        campaign.counts["two programs on one store"] += 1


def use_other_store(campaign, work):
    """A store of another version of the program is refused and kept."""
    work.reference()
    folder = campaign.folder()
    work.run(folder)
    store = sqlite3.connect(folder / "sweep.sqlite")
    store.execute("UPDATE meta SET value = 'stopline runs 1' WHERE key = 'format'")
    store.commit()
    store.close()
    code, error = work.run(folder)
    if code != 2 or "another version of the program wrote this store" not in error:
        campaign.fail(f"store of another version: exit code {code}: {error}")
    (folder / "sweep.sqlite").unlink()
    work.check_finished(folder, "after a store of another version")
    campaign.counts["store of another version"] += 1


def kill_a_rank(campaign, work, cases):
    """Kills one rank of mpirun. The same command then finishes the sweep."""
    mpirun = shutil.which("mpirun")
    libraries = subprocess.run(["ldd", campaign.program("sweep")], capture_output=True, text=True).stdout
    if mpirun is None or "libmpi" not in libraries:
        print("  no mpirun, or the programs are built without MPI; left out")
        return
    work.reference()
    environment = {**work.environment, "PATH": os.environ["PATH"], "OMPI_ALLOW_RUN_AS_ROOT": "1",
                   "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "TMPDIR": "/tmp"}
    for _ in range(cases):
        folder = campaign.folder()
        command = [argument for argument in work.command(folder) if argument not in ("--threads", "2")]
        job = subprocess.Popen([mpirun, "--oversubscribe", "-n", "3", *command], cwd=campaign.work, env=environment,
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        ranks = []
        end = time.monotonic() + 30
        while len(ranks) < 3 and job.poll() is None and time.monotonic() < end:
            time.sleep(0.01)
            ranks = children_of(job.pid)
        time.sleep(campaign.draw.uniform(0.0, work.whole_s))
        if ranks:
            try:
                os.kill(campaign.draw.choice(ranks), signal.SIGKILL)
            except ProcessLookupError:
                pass
        job.wait()
        time.sleep(0.5)  # the other ranks end
        work.check_partial(folder, "a rank died")
        work.check_finished(folder, "after a rank died")
        campaign.counts["killed ranks"] += 1


def children_of(process):
    try:
        text = Path(f"/proc/{process}/task/{process}/children").read_text()
    except OSError:
        return []
    return [int(word) for word in text.split()]


def move_clock(campaign, work, shim, cases):
    """The time of day jumps by up to a day at each call. Results do not depend on it."""
    work.reference()
    for _ in range(cases):
        folder = campaign.folder()
        code, error = work.run(folder, LD_PRELOAD=str(shim), FAULT_CLOCK="86400")
        if code != 0:
            campaign.fail(f"{work.name}, clock jumps: exit code {code}: {error}")
        work.check_partial(folder, "clock jumps")
        work.check_finished(folder, "after clock jumps")
        campaign.counts["clock jumps"] += 1


def build_shim(folder):
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        return None
    shim = folder / "fault_shim.so"
    subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", shim, Path(__file__).with_name("fault_shim.c"), "-ldl"],
                   check=True)
    return shim


def run_all(campaign, shim, arguments):
    work = works(campaign)
    if arguments.short:
        kill_at_random(campaign, work["sweep"], 5)
        kill_at_random(campaign, work["run"], 3, (signal.SIGTERM, signal.SIGHUP, signal.SIGINT))
        fail_calls(campaign, work["sweep"], shim, 10)
        fail_calls(campaign, work["run"], shim, 10)
        share_a_store(campaign, work["sweep"], 1)
        use_other_store(campaign, work["sweep"])
        move_clock(campaign, work["sweep"], shim, 1)
        return
    shares = {"sweep": 0.4, "run": 0.15, "scorecard": 0.15, "calibration": 0.15, "sweep with figures": 0.1,
              "report": 0.05}
    for name, share in shares.items():
        print(f"kills: {name}", flush=True)
        kill_at_random(campaign, work[name], max(1, round(share * arguments.kills)))
    ended = max(1, arguments.kills // 10)
    for name in ("sweep", "run", "scorecard"):
        print(f"orderly ends: {name}", flush=True)
        kill_at_random(campaign, work[name], ended, (signal.SIGTERM, signal.SIGHUP, signal.SIGINT))
    for name in ("run", "sweep", "scorecard", "sweep with figures", "calibration"):
        print(f"failing calls: {name}", flush=True)
        fail_calls(campaign, work[name], shim, max(10, arguments.kills // 5))
    for name in ("run", "sweep"):
        fill_disks(campaign, work[name], ended)
        use_read_only_folder(campaign, work[name])
    share_a_store(campaign, work["sweep"], ended)
    use_other_store(campaign, work["sweep"])
    kill_a_rank(campaign, work["sweep"], max(1, ended // 2))
    move_clock(campaign, work["sweep"], shim, ended // 2)
    move_clock(campaign, work["scorecard"], shim, ended // 2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", help="folder of the programs")
    parser.add_argument("--kills", type=int, default=200, help="number of kills (default: 200)")
    parser.add_argument("--seed", type=int, default=None, help="seed of the random moments (default: a new one)")
    parser.add_argument("--short", action="store_true", help="a selection of about 20 s")
    arguments = parser.parse_args()
    seed = arguments.seed if arguments.seed is not None else random.SystemRandom().randrange(1_000_000)
    print(f"seed {seed}", flush=True)
    with tempfile.TemporaryDirectory() as name:
        shim = build_shim(Path(name))
        if shim is None:
            print("skipped: there is no C compiler")
            return 77
        campaign = Campaign(arguments.bin, Path(name), seed)
        run_all(campaign, shim, arguments)
    for what, count in sorted(campaign.counts.items()):
        print(f"{count:5}  {what}")
    print(f"{sum(campaign.counts.values()):5}  faults in all, {len(campaign.failures)} failures")
    return 1 if campaign.failures else 0


if __name__ == "__main__":
    sys.exit(main())
