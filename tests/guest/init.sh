#!/busybox/busybox sh
# First process of the guest. All files are in memory: those that run.sh has packed, and busybox instead of Debian's
# utilities. run.sh has packed the command too, and reads its exit code from the console.
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
