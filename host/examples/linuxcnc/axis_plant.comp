component axis_plant "An axis of a simulated machine: a program that speaks axis-plant/1, asked once a period";
pin in float volts "command of the amplifier, V";
pin in bit enable = 1 "false: the amplifier is off";
pin out float position "as the encoder reads it, mm (m of a linear drive)";
pin out bit fault "the program has ended, does not answer or answers nonsense; position then stays";
modparam dummy program """of each instance, a file to execute: loadrt axis_plant count=2 program=./x.sh,./y.sh""";
variable int axis;
variable int started;
variable rtapi_s64 periods;
option extra_setup;
option extra_cleanup;
function _ fp "Lets the machine run for one period with what stands at volts";
license "GPL";
;;
#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#define MOST_AXES 8
#define PATIENCE_MS 10000

static char *program[MOST_AXES];
RTAPI_MP_ARRAY_STRING(program, MOST_AXES, "a program an instance");
static pid_t children[MOST_AXES];
static int links[MOST_AXES];

/* Sends a line and waits for the complete answer line; false if none arrives. */
static int ask(int there, const char *line, char *answer, int size) {
  struct pollfd readable = {there, POLLIN, 0};
  int length = 0;
  if (send(there, line, strlen(line), MSG_NOSIGNAL) != (ssize_t)strlen(line)) return 0;
  while (length < size - 1 && poll(&readable, 1, PATIENCE_MS) > 0) {
    const ssize_t got = recv(there, answer + length, size - 1 - length, 0);
    if (got <= 0) return 0;
    length += got;
    answer[length] = 0;
    if (answer[length - 1] == '\n') return 1;
  }
  return 0;
}

EXTRA_SETUP() {
  int ends[2], k;
  if (extra_arg >= MOST_AXES || !program[extra_arg]) {
    rtapi_print_msg(RTAPI_MSG_ERR, "axis_plant: %s has no program: loadrt axis_plant program=./x.sh\n", prefix);
    return -EINVAL;
  }
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return -errno;
  children[extra_arg] = fork();
  if (children[extra_arg] < 0) return -errno;
  if (children[extra_arg] == 0) { /* rtapi_app may run as root; the program runs as the user */
    if (setresgid(getgid(), getgid(), getgid()) != 0 || setresuid(getuid(), getuid(), getuid()) != 0) _exit(126);
    dup2(ends[1], STDIN_FILENO);
    dup2(ends[1], STDOUT_FILENO);
    for (k = STDERR_FILENO + 1; k < 1024; ++k) close(k);
    execl(program[extra_arg], program[extra_arg], (char *)0);
    _exit(127);
  }
  close(ends[1]);
  axis = extra_arg;
  links[axis] = ends[0];
  return 0;
}

FUNCTION(_) {
  char line[96], answer[96];
  long long k = -1;
  double x = 0.0;
  if (fault) return;
  if (!started) {
    snprintf(line, sizeof line, "axis-plant/1 1 %.9g\n", period * 1e-9);
    started = ask(links[axis], line, answer, sizeof answer) && strncmp(answer, "ready", 5) == 0;
  }
  if (enable)
    snprintf(line, sizeof line, "%lld %.17g\n", (long long)periods, volts);
  else
    snprintf(line, sizeof line, "%lld off\n", (long long)periods);
  if (!started || !ask(links[axis], line, answer, sizeof answer) || sscanf(answer, "%lld %lf", &k, &x) != 2 ||
      k != periods) {
    fault = 1;
    k = periods;
    rtapi_print_msg(RTAPI_MSG_ERR, "axis_plant: %s does not answer in period %lld\n", program[axis], k);
    return;
  }
  ++periods;
  position = x;
}

/* The end of its input ends a program. */
EXTRA_CLEANUP() {
  int k;
  for (k = 0; k < MOST_AXES; ++k) {
    if (children[k] <= 0) continue;
    close(links[k]);
    waitpid(children[k], 0, 0);
  }
}
