#!/bin/sh
# Stands for turner where no scene has to be drawn: "render" copies $FAKE_PICTURE, or ends with
# $FAKE_STATUS; "devices" ends with $FAKE_DEVICES; "compare" is the real one.
case $1 in
render)
    if [ "${FAKE_STATUS:-0}" != 0 ]; then
        echo "turner: error: no such luck" >&2
        exit "$FAKE_STATUS"
    fi
    [ "$2 $3" = "$FAKE_SCENE -o" ] || exit 2
    case "$*" in *"--size 1x1"*) cp "$FAKE_PICTURE" "$4" ;; *) exit 2 ;; esac
    ;;
devices) exit "${FAKE_DEVICES:-0}" ;;
compare) exec "$REAL_TURNER" "$@" ;;
esac
