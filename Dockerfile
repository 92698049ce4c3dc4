# docker build --tag touchstone . && docker run --rm touchstone
# The tool and the checker on Debian 12. A run decides the built-in set and judges the solvers on it; other commands
# are arguments: docker run --rm --volume "$PWD:/data" touchstone ./run certify /data/queries
FROM debian:12
COPY . /touchstone
WORKDIR /touchstone
RUN ./run build && rm -rf /var/lib/apt/lists/* /root/.cache
CMD ["./run", "certify"]
