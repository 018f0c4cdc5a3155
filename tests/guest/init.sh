#!/busybox/busybox sh
# First process of the guest, whose files are all in memory: those of the starter, and what Debian's utilities have in
# busybox. The starter left the command; it learns the exit code from the console.
/busybox/busybox mkdir -p /dev /proc /sys /run /tmp
/busybox/busybox --install -s /busybox
export PATH=/busybox
chmod 1777 /tmp
mount -t proc none /proc
mount -t sysfs none /sys
mount -t devtmpfs none /dev
mkdir /dev/shm
while read -r module; do insmod "/modules/$module" || echo "guest: $module does not load"; done </modules/order
ip link set lo up
echo "guest: started" >/dev/kmsg
echo "guest: started"
env -i PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin:/busybox HOME=/run LC_ALL=C.UTF-8 AXIS_GUEST=1 \
  /bin/bash /command
code=$?
echo
[ $code = 0 ] || dmesg | sed -e '1,/guest: started/d' -e 's/^/kernel: /'
echo "guest: ended with $code"
poweroff -f
