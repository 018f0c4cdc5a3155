#!/bin/busybox sh
# First process of the guest. This machine's files are its root, read-only; /run/guest is shared with the starter, which
# left the command there and finds the exit code there.
/bin/busybox --install -s /bin
export PATH=/bin
mount -t proc none /proc
while read -r module; do insmod "/modules/$module" || echo "guest: $module does not load"; done </modules/order
mkdir /host
mount -t 9p -o trans=virtio,version=9p2000.L,ro,msize=512000,cache=loose root /host || poweroff -f
mount -t proc none /host/proc
mount -t sysfs none /host/sys
mount -t devtmpfs none /host/dev
mkdir -p /host/dev/shm
mount -t tmpfs none /host/dev/shm
mount -t tmpfs none /host/run
mkdir /real_tmp
mount -o bind /host/tmp /real_tmp
mount -t tmpfs none /host/tmp
mkdir /host/run/guest
mount -t 9p -o trans=virtio,version=9p2000.L,msize=512000 shared /host/run/guest || poweroff -f
# A checkout below /tmp stays in sight.
project=$(cat /host/run/guest/project)
case "$project" in
  /tmp/*) mkdir -p "/host$project" && mount -o bind "/real_tmp${project#/tmp}" "/host$project" ;;
esac
ip link set lo up
echo "guest: started"
echo "guest: started" >/host/dev/kmsg
chroot /host /usr/bin/env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/run LC_ALL=C.UTF-8 \
  AXIS_GUEST=1 SYSTEMD_IGNORE_CHROOT=1 /bin/bash /run/guest/command
echo $? >/host/run/guest/exit_code
dmesg | sed '1,/guest: started/d' >/host/run/guest/kernel.log
sync
poweroff -f
